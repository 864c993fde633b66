"""Opening a video file safely; what its headers and packets say, with nothing decoded."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.container import InputContainer
from av.stream import Disposition
from av.video.stream import VideoStream

from engine.errors import InputError
from engine.media.decoding.timing import without_echoes
from engine.media.limits import Limits

# The demuxer is chosen by our own look at the first bytes: FFmpeg's guessing would also take playlists and scripts,
# which name further files and addresses to read.
_DEMUXERS = {
    "video/mp4": "mov",
    "video/quicktime": "mov",
    "video/webm": "matroska",
    "video/x-matroska": "matroska",
    "video/x-msvideo": "avi",
    "image/gif": "gif",
    "image/apng": "apng",
}
_HIGHEST_RATE = 480.0
"""Frames a second; a header that claims more states its clock, not its rate."""


@dataclass(frozen=True)
class Header:
    """What a file claims of its video: `width`, `height` in pixels as coded, `fps` (0 if unknown), `seconds` (0 if
    unknown), `frames` (0 if unknown), `codec` (FFmpeg's name), `pixel_aspect` width to height."""

    width: int
    height: int
    fps: float
    seconds: float
    frames: int
    codec: str
    pixel_aspect: float = 1.0


@dataclass(frozen=True)
class Timetable:
    """When the frames are to be shown.

    times : (n,) float64 seconds on the file's clock, ascending.
    last : seconds that the last frame stays.
    cut : whether the file ends before what its header announces.
    has_sound : whether there is any beside, for a track of it may be empty.
    """

    times: np.ndarray
    last: float
    cut: bool
    has_sound: bool = False

    @property
    def seconds(self) -> float:
        """From the first frame's beginning to the last one's end."""
        return float(self.times[-1] - self.times[0]) + self.last

    @property
    def step(self) -> float:
        """The usual seconds between two frames."""
        return float(np.median(np.diff(self.times))) if len(self.times) > 1 else self.last


def open_container(path: Path, media_type: str, limits: Limits | None = None) -> InputContainer:
    """Open a file by the demuxer of its media type; the caller closes it. Raises `video_unreadable`."""
    options = {"protocol_whitelist": "file", **_decoder_options(limits or Limits())}
    try:
        return av.open(str(path), "r", format=_DEMUXERS[media_type], options=options)
    except (av.FFmpegError, ValueError) as error:
        raise unreadable() from error


def video_stream(container: InputContainer) -> VideoStream | None:
    """The main stream of moving pictures: not a cover picture, nor the depth that some phones add."""
    stream = cast(VideoStream | None, container.streams.best("video"))
    return None if stream is None or stream.disposition & Disposition.attached_pic else stream


@contextmanager
def open_video(path: Path, media_type: str, limits: Limits) -> Iterator[tuple[InputContainer, VideoStream]]:
    """The container and its video stream, ready to decode. Raises `video_unreadable`, `no_video_stream`."""
    with open_container(path, media_type, limits) as container:
        stream = video_stream(container)
        if stream is None:
            raise without_picture()
        if stream.codec_context is None:  # a codec that FFmpeg cannot decode
            raise unreadable()
        stream.codec_context.options = _decoder_options(limits)
        stream.thread_type = "AUTO"
        stream.codec_context.thread_count = min(os.cpu_count() or 1, 4)
        yield container, stream


def _decoder_options(limits: Limits) -> dict[str, str]:
    return {"max_pixels": str(int(limits.video_megapixels * 1.1e6))}  # in case a frame belies the header


def header_of(container: InputContainer, stream: VideoStream) -> Header:
    """What the file claims."""
    seconds = float(stream.duration * stream.time_base) if stream.duration and stream.time_base else 0.0
    if not seconds and container.duration:
        seconds = container.duration / av.time_base
    aspect = float(stream.sample_aspect_ratio or 1)
    rates = (float(rate) for rate in (stream.average_rate, stream.guessed_rate) if rate)
    return Header(
        width=stream.width,
        height=stream.height,
        fps=next((rate for rate in rates if rate <= _HIGHEST_RATE), 0.0),
        seconds=max(seconds, 0.0),
        frames=stream.frames,
        codec=stream.codec_context.name,
        pixel_aspect=aspect if 0.25 <= aspect <= 4 else 1.0,  # beyond, it is a mistake
    )


def timetable_of(container: InputContainer, stream: VideoStream, header: Header, limits: Limits) -> Timetable:
    """Read all packets' timestamps, until the end or until a limit is passed (which the caller then finds).

    Raises `video_unreadable` where there is no packet at all.
    """
    times: list[float] = []
    step = 1 / header.fps if header.fps else 1 / 25
    end, any_end, cut, earliest, has_sound = -np.inf, -np.inf, False, np.inf, False
    try:
        for packet in container.demux(stream, *container.streams.audio):
            if packet.size == 0 or packet.is_discard:
                continue
            time, length = _seconds(packet)
            if packet.stream_index == stream.index:
                if time is None:
                    time = times[-1] + step if times else 0.0
                times.append(time)
                earliest = min(earliest, time)
                end = max(end, time + (length or step))
                if len(times) > limits.video_frames or end - earliest > limits.video_seconds + 1:
                    break
            else:
                has_sound = True
            if time is not None:
                any_end = max(any_end, time + length)
    except av.FFmpegError:
        cut = True
    if not times:
        raise unreadable()
    shown = without_echoes(np.array(times))
    # A stream without a length of its own is measured by the container's, which is that of its longest stream.
    reached = (end if stream.duration else max(end, any_end)) - earliest
    cut = (
        cut
        or _lacks_trailer(container)
        or reached < header.seconds - max(0.5, 3 * step)
        or len(times) < header.frames - 3
    )
    return Timetable(shown, max(float(end - shown[-1]), 1e-3), bool(cut), has_sound)


def _lacks_trailer(container: InputContainer) -> bool:
    """Whether the file does not end as its format must, for the formats that state no length."""
    ends = {"gif": b"\x3b", "apng": b"IEND\xaeB`\x82"}.get(container.format.name)
    if ends is None:
        return False
    with Path(container.name).open("rb") as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - 64))
        return not file.read().rstrip(b"\0\r\n ").endswith(ends)


def _seconds(packet: av.Packet) -> tuple[float | None, float]:
    stamp = packet.pts if packet.pts is not None else packet.dts
    if stamp is None or not packet.time_base:
        return None, 0.0
    return float(stamp * packet.time_base), float((packet.duration or 0) * packet.time_base)


def unreadable() -> InputError:
    """The error for a video that cannot be opened, or of which no frame decodes."""
    return InputError(
        "video_unreadable",
        "The video cannot be read: it is damaged, cut off before its index, or of an unknown codec. Send it again, or "
        "as MP4 (H.264).",
    )


def without_picture() -> InputError:
    """The error for a file of sound alone."""
    return InputError("no_video_stream", "The file has sound but no moving picture: send a video.")
