"""Opening a video file safely, and what its packets say without decoding any of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import av
import numpy as np
from av.container import InputContainer
from av.stream import Disposition
from av.video.stream import VideoStream

from engine.errors import InputError
from engine.media.limits import Limits
from engine.media.sniff import VIDEO_TYPES, sniff

# The demuxer is chosen by our own look at the first bytes: FFmpeg's guessing would also take playlists and
# scripts, which name other files and addresses to read.
_DEMUXERS = {
    "video/mp4": "mov",
    "video/quicktime": "mov",
    "video/webm": "matroska",
    "video/x-matroska": "matroska",
    "video/x-msvideo": "avi",
    "image/gif": "gif",
    "image/apng": "apng",
}


@dataclass(frozen=True)
class Packets:
    """The timetable of a video stream: `times` (n,) float64 seconds, sorted, when each frame is to be shown;
    `end` seconds, when the last one ends; `container_end` seconds, when the last packet of any stream ends;
    `damaged` whether the file broke off while it was read."""

    times: np.ndarray
    end: float
    container_end: float
    damaged: bool


def admit_video(path: Path, limits: Limits) -> str:
    """The media type of a file that may be a video. Raises `InputError` where it cannot be one."""
    size = path.stat().st_size
    if size == 0:
        raise InputError("file_empty", "The video file is empty (0 bytes): send it again.")
    if size > limits.video_bytes:
        raise InputError(
            "file_too_large",
            f"The video file has {size / 1e6:.0f} MB, the limit is {limits.video_bytes / 1e6:.0f} MB: send a shorter "
            "or smaller one.",
        )
    media_type = sniff(path)
    if media_type is not None and media_type.startswith("audio/"):
        raise _no_stream()
    if media_type not in VIDEO_TYPES:
        what = f"a file of type {media_type}" if media_type else "no video"
        raise InputError("not_a_video", f"This is {what}: send an MP4, MOV, WebM, MKV or GIF video.")
    return media_type


@contextmanager
def open_video(path: Path, media_type: str, limits: Limits) -> Iterator[tuple[InputContainer, VideoStream]]:
    """The container and its video stream (not a cover picture). Raises `video_unreadable`, `no_video_stream`."""
    options = {"protocol_whitelist": "file", "max_pixels": str(int(limits.video_megapixels * 1e6))}
    try:
        container = av.open(str(path), "r", format=_DEMUXERS[media_type], options=options)
    except (av.FFmpegError, ValueError) as error:
        raise unreadable() from error
    with container:
        streams = [s for s in container.streams.video if not s.disposition & Disposition.attached_pic]
        if not streams:
            raise _no_stream()
        stream = streams[0]
        stream.thread_type = "AUTO"
        stream.codec_context.thread_count = min(os.cpu_count() or 1, 4)
        yield container, stream


def scan_packets(container: InputContainer, stream: VideoStream, limits: Limits) -> Packets:
    """Read the timetable by demuxing, until the end or until a limit is clearly passed."""
    times: list[float] = []
    end = container_end = -np.inf
    damaged = False
    base = float(stream.time_base or 0)
    step = 1.0 / float(stream.guessed_rate or 25)
    try:
        for packet in container.demux():
            if packet.size == 0 or packet.time_base is None or packet.is_discard:
                continue
            scale = float(packet.time_base)
            stamp = packet.pts if packet.pts is not None else packet.dts
            length = (packet.duration or 0) * scale
            time = stamp * scale if stamp is not None else None
            if packet.stream_index == stream.index:
                if time is None or base == 0:
                    time = times[-1] + step if times else 0.0
                times.append(time)
                end = max(end, time + (length or step))
            if time is not None:
                container_end = max(container_end, time + length)
            if len(times) > limits.video_frames or (times and end - times[0] > limits.video_seconds + 1):
                break
    except av.FFmpegError:
        damaged = True
    return Packets(np.unique(np.array(times)), end, max(container_end, end), damaged)


def unreadable() -> InputError:
    """The error for a video that cannot be opened or of which no frame decodes."""
    return InputError(
        "video_unreadable",
        "The video cannot be read: it is damaged, cut off before its index, or of an unknown codec. Send it again, or "
        "as MP4 (H.264).",
    )


def _no_stream() -> InputError:
    return InputError("no_video_stream", "The file has sound but no moving picture: send a video.")
