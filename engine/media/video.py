"""Videos in: what a clip is, and its frames one by one, upright, in sRGB, at a constant rate."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from math import inf
from pathlib import Path

import numpy as np
from av.video.frame import VideoFrame

from engine.errors import InputError
from engine.media.clip import Clip, open_clip, too_short
from engine.media.colour_conversion.colour import SrgbConverter
from engine.media.decoding.decode import Damage
from engine.media.decoding.demux import unreadable
from engine.media.decoding.timing import MIN_SPAN_SECONDS
from engine.media.limits import Limits

Warn = Callable[[str, str], None]


@dataclass(frozen=True)
class VideoInfo:
    """What a video is.

    width, height : pixels as shown (upright, pixels square).
    fps : frames a second, for a variable rate a usual rate that hardly loses a frame.
    frames : how many `read_video` gives of itself; fewer where the file is damaged.
    seconds : how long it plays.
    has_sound : whether there is any.
    variable_rate : whether its frames stay for different times.
    hdr : "hlg", "pq" or None.
    codec : by FFmpeg's name.
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
    """One frame: `rgb` uint8 (H, W, 3) sRGB, which the next frame may share (copy before changing it); `time` seconds
    since the clip's first frame."""

    rgb: np.ndarray
    time: float


def probe_video(path: Path, limits: Limits | None = None) -> VideoInfo:
    """What a video is, from its headers and its packets' timestamps; once the limits are known to hold, its first
    frame is decoded too (it says how the clip is turned, and whether it is HDR).

    Raises `InputError`: `file_empty`, `file_too_large`, `not_a_video`, `video_unreadable`, `no_video_stream`,
    `video_too_large`, `video_too_long`, `video_pixel_rate`, `video_too_many_frames`, `video_too_short` (one frame).
    """
    clip = open_clip(path, limits or Limits())
    seconds = clip.timetable.seconds
    width, height = clip.size[::-1] if clip.orientation.swaps_sides else clip.size
    return VideoInfo(
        width=width,
        height=height,
        fps=clip.rate.fps,
        frames=round((seconds - clip.timetable.last) * clip.rate.fps) + 1
        if clip.rate.constant
        else len(clip.timetable.times),
        seconds=seconds,
        has_sound=clip.timetable.has_sound,
        variable_rate=not clip.rate.constant,
        hdr=None if clip.transfer == "sdr" else clip.transfer,
        codec=clip.header.codec,
    )


def read_video(
    path: Path,
    fps: float | None = None,
    trim: tuple[float, float] | None = None,
    limits: Limits | None = None,
    warn: Warn | None = None,
    longest_side: int | None = None,
) -> Iterator[Frame]:
    """The frames of a video, one by one; memory stays flat.

    Parameters
    ----------
    fps : frames a second to give, picked by their timestamps, never blended; None keeps each frame, of a clip of
        variable rate at its own time. Over frames that do not decode, the one before is held.
    trim : (start, end) seconds of the clip; the frames' times still count from the clip's beginning. However short it
        is, and the clip at a low rate, there is one frame.
    warn : called with (code, message): `video_truncated` (the end is missing; what there is, is used),
        `video_damaged` (some frames do not decode).
    longest_side : pixels; frames whose longer side is longer are scaled down to it (cheaper than doing it after).

    Raises what `probe_video` raises, and `trim_outside`.
    """
    clip = open_clip(path, limits or Limits())
    start, end = trim or (0.0, inf)
    seconds = clip.timetable.seconds
    if not 0 <= start < end or start >= seconds:
        raise InputError(
            "trim_outside",
            f"There is nothing between {start:g} s and {end:g} s: the video lasts {seconds:.2f} s.",
            ("trim",),
        )
    least = MIN_SPAN_SECONDS if fps is None and not clip.rate.constant else 0.5 / (fps or clip.rate.fps)
    damage = Damage()
    converter = SrgbConverter(clip.scaled_size(longest_side))
    shown: tuple[VideoFrame, np.ndarray] | None = None
    for time, frame in clip.frames(fps, start, damage):
        if time > end - least:
            break
        if shown is None or shown[0] is not frame:
            shown = frame, clip.orientation.apply(converter.convert(frame))
        yield Frame(shown[1], time)
    if shown is None:  # the part is shorter than half a frame: what is on show in its middle stands for it
        for time, frame in islice(clip.frames(1 / (min(end, seconds) - start), start, Damage()), 1):
            shown = frame, clip.orientation.apply(converter.convert(frame))
            yield Frame(shown[1], time)
    if shown is None:
        raise unreadable()
    if damage.frames < 2 and trim is None:
        raise too_short()
    if warn is not None:
        report_damage(clip, damage, end, warn)


def report_damage(clip: Clip, damage: Damage, end: float, warn: Warn) -> None:
    """Say what was amiss with a clip that was read up to `end` seconds, as `read_video` does."""
    broke_off = damage.errors > 0 and damage.frames - damage.last_error < clip.rate.fps / 2
    if end >= clip.timetable.seconds and (clip.timetable.cut or broke_off):
        warn("video_truncated", f"The video breaks off: the {damage.frames} frames before that were used.")
    elif damage.errors:
        warn("video_damaged", f"{damage.errors} parts of the video do not decode: the frame before each is held.")
