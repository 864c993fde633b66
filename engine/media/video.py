"""Videos in: what the headers say, and the frames one by one, upright, in sRGB, at a constant rate."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import av
import numpy as np
from av.video.frame import VideoFrame
from av.video.reformatter import VideoReformatter

from engine.errors import InputError
from engine.media.colour import to_rgb
from engine.media.demux import Packets, admit_video, open_video, scan_packets, unreadable
from engine.media.display import Orientation, orientation_of
from engine.media.limits import Limits
from engine.media.timing import constant_rate, nominal_rate, resample

Warn = Callable[[str, str], None]


@dataclass(frozen=True)
class VideoInfo:
    """What a video is.

    `width`, `height` in pixels as shown (turned upright, pixels square); `fps` frames a second, for a
    variable rate a usual rate that loses no frames; `frames` how many `read_video` will give at that rate
    (an estimate where the file is damaged); `seconds`; `hdr` "hlg", "pq" or None; `codec` by FFmpeg's name.
    """

    width: int
    height: int
    fps: float
    frames: int
    seconds: float
    has_sound: bool
    variable_rate: bool
    hdr: str | None
    codec: str


@dataclass(frozen=True)
class Frame:
    """One frame: `rgb` uint8 (H, W, 3) sRGB; `time` seconds since the first frame of the clip."""

    rgb: np.ndarray
    time: float


def probe_video(path: Path, limits: Limits | None = None) -> VideoInfo:
    """What a video is, from its headers and its packets' timestamps; its first frame alone is decoded, once the
    limits are known to hold, because it carries how the clip is turned.

    Raises `InputError`: `file_empty`, `file_too_large`, `not_a_video`, `video_unreadable`, `no_video_stream`,
    `video_too_large`, `video_too_long`, `video_pixel_rate`, `video_too_many_frames`, `video_too_short` (one frame).
    """
    return _probe(path, limits or Limits())[0]


def read_video(
    path: Path,
    fps: float | None = None,
    trim: tuple[float, float] | None = None,
    limits: Limits | None = None,
    warn: Warn | None = None,
) -> Iterator[Frame]:
    """The frames of a video, one by one; memory stays flat.

    Parameters
    ----------
    fps : frames a second to give; None keeps each frame of a clip of constant rate, and takes `VideoInfo.fps` for
        one of variable rate. Frames are picked by their timestamps, never blended.
    trim : (start, end) in seconds of the clip; frame times still count from the clip's beginning.
    warn : called with (code, message): `video_truncated`, `video_damaged`.

    Raises what `probe_video` raises, and `trim_outside`.
    """
    limits = limits or Limits()
    info, origin, packets = _probe(path, limits)
    start, end = trim or (0.0, np.inf)
    rate = fps or info.fps
    shown = _decode(path, limits, origin, (start, end), packets, warn or (lambda code, message: None))
    for time, rgb in resample(shown, rate, start, 1 / info.fps):
        if time >= end - 0.5 / rate:
            return
        yield Frame(rgb, time)


def _probe(path: Path, limits: Limits) -> tuple[VideoInfo, float, Packets]:
    media_type = admit_video(path, limits)
    with open_video(path, media_type, limits) as (container, stream):
        context = stream.codec_context
        rate = float(stream.average_rate or 0)
        header_seconds = float(stream.duration * stream.time_base) if stream.duration and stream.time_base else 0.0
        if not header_seconds and container.duration:
            header_seconds = container.duration / av.time_base
        _check(stream.width, stream.height, rate, header_seconds, stream.frames, limits)
        has_sound = bool(container.streams.audio)
        packets = scan_packets(container, stream, limits)
        if len(packets.times) == 0:
            raise unreadable()
        if len(packets.times) < 2:
            raise InputError("video_too_short", "The video has a single frame: send a clip that moves.")
        candidates = [float(r) for r in (stream.average_rate, stream.guessed_rate) if r]
        constant = constant_rate(packets.times, candidates)
        fps = constant or nominal_rate(packets.times)
        seconds = float(packets.end - packets.times[0])
        _check(stream.width, stream.height, fps, seconds, len(packets.times), limits)
        codec = context.name
    width, height, orientation, hdr = _first_frame(path, media_type, limits)
    if orientation.swaps_sides:
        width, height = height, width
    frames = len(packets.times) if constant else round(seconds * fps)
    info = VideoInfo(width, height, fps, frames, seconds, has_sound, constant is None, hdr, codec)
    return info, float(packets.times[0]), packets


def _check(width: int, height: int, fps: float, seconds: float, frames: int, limits: Limits) -> None:
    if width * height > limits.video_megapixels * 1e6:
        raise InputError(
            "video_too_large",
            f"The video is {width} x {height}: scale it to at most {limits.video_megapixels:g} megapixels a frame.",
        )
    if seconds > limits.video_seconds:
        raise InputError(
            "video_too_long",
            f"The video lasts {seconds:.0f} s, the limit is {limits.video_seconds:g} s: cut it.",
        )
    if width * height * fps > limits.video_megapixels_per_second * 1e6:
        raise InputError(
            "video_pixel_rate",
            f"The video has {width} x {height} pixels at {fps:.0f} frames a second: send it smaller or at a lower rate "
            f"(at most {limits.video_megapixels_per_second:g} megapixels a second).",
        )
    if frames > limits.video_frames:
        raise InputError(
            "video_too_many_frames",
            f"The video has {frames} frames, the limit is {limits.video_frames}: cut it, or lower its rate.",
        )


def _first_frame(path: Path, media_type: str, limits: Limits) -> tuple[int, int, Orientation, str | None]:
    with open_video(path, media_type, limits) as (container, stream):
        for frame in _frames(container, stream):
            width, height = _square(frame)
            hdr = {16: "pq", 18: "hlg"}.get(frame.color_trc)
            return width, height, orientation_of(frame), hdr
    raise unreadable()


def _square(frame: VideoFrame) -> tuple[int, int]:
    """Width and height with square pixels."""
    return frame.width, frame.height


def _frames(container, stream) -> Iterator[VideoFrame]:  # type: ignore[no-untyped-def]
    demuxed = container.demux(stream)
    while True:
        try:
            packet = next(demuxed, None)
        except av.FFmpegError:
            packet = None
        try:
            yield from stream.decode(packet)
        except av.EOFError:
            return
        except av.FFmpegError:
            pass
        if packet is None:
            return


def _decode(
    path: Path, limits: Limits, origin: float, trim: tuple[float, float], packets: Packets, warn: Warn
) -> Iterator[tuple[float, np.ndarray]]:
    media_type = admit_video(path, limits)
    reformatter = VideoReformatter()
    with open_video(path, media_type, limits) as (container, stream):
        step = 1 / float(stream.guessed_rate or 25)
        time = -step
        for frame in _frames(container, stream):
            stamp = frame.time
            time = stamp - origin if stamp is not None else time + step
            if time < trim[0] - step:
                continue
            if time > trim[1] + step:
                return
            width, height = _square(frame)
            yield time, orientation_of(frame).apply(to_rgb(frame, reformatter, width, height))
