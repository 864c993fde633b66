"""A video file that was let in: measured against the limits by its headers, and ready to be decoded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

from av.video.frame import VideoFrame

from engine.errors import InputError
from engine.media.admission import admit_video, check_claims, check_video
from engine.media.colour_conversion.colour import transfer_of
from engine.media.colour_conversion.tone_mapping import Transfer
from engine.media.decoding import animated_webp
from engine.media.decoding.decode import Damage, decode
from engine.media.decoding.demux import Header, Timetable, header_of, open_video, timetable_of, unreadable
from engine.media.decoding.display import Orientation, orientation_of
from engine.media.decoding.timing import Rate, at_own_times, rate_of, resample
from engine.media.limits import Limits


@dataclass(frozen=True)
class Clip:
    """A video within its `limits`: `size` (width, height) with square pixels, before it is turned upright."""

    path: Path
    media_type: str
    limits: Limits
    header: Header
    timetable: Timetable
    rate: Rate
    size: tuple[int, int]
    orientation: Orientation
    transfer: Transfer

    def frames(self, fps: float | None, start: float, damage: Damage) -> Iterator[tuple[float, VideoFrame]]:
        """(seconds, frame) from `start` seconds on, at `fps`, or at the clip's own rate and on its own grid; where that
        changes, at the frames' own times."""
        decoded = decode(self.path, self.media_type, self.timetable, self.limits, start, damage)
        own, rate = self.rate, fps or self.rate.fps
        last = 1 / own.fps if own.constant else self.timetable.last
        if fps is None and not own.constant:
            yield from at_own_times(decoded, start)
        elif fps is None:
            start = round(start * own.fps) / own.fps
            for time, frame in resample(decoded, rate, own.phase + start, last):
                yield time - own.phase, frame
        else:
            yield from resample(decoded, rate, start, last)

    def scaled_size(self, longest_side: int | None) -> tuple[int, int]:
        """`size`, shrunk so that neither side is longer."""
        scale = min(1.0, (longest_side or inf) / max(self.size))
        return max(1, round(self.size[0] * scale)), max(1, round(self.size[1] * scale))


def open_clip(path: Path, limits: Limits) -> Clip:
    """Let a video in. The limits are checked on what the headers claim, then on what the packets show, before a frame
    is decoded. Then the first frame is, for it carries how the clip is turned and how it stands for light.

    Raises `InputError`: what `admit_video`, `check_video`, `open_video` raise, and `video_too_short`.
    """
    media_type = admit_video(path, limits)
    header, timetable = _read_headers(path, media_type, limits)
    if len(timetable.times) < 2:
        raise too_short()
    rate = rate_of(timetable.times, [header.fps] if header.fps else [])
    if not rate.constant:  # the last frame is shown, too
        timetable = replace(timetable, last=max(timetable.last, 1 / rate.fps))
    size = round(header.width * header.pixel_aspect), header.height
    count = len(timetable.times)
    decoded = (count - 1) / float(timetable.times[-1] - timetable.times[0])  # a second, in the mean
    check_video(*size, decoded, timetable.seconds, count, limits)
    first = next(decode(path, media_type, timetable, limits, 0.0, Damage()), None)
    if first is None:
        raise unreadable()
    _, frame = first
    return Clip(path, media_type, limits, header, timetable, rate, size, orientation_of(frame), transfer_of(frame))


def _read_headers(path: Path, media_type: str, limits: Limits) -> tuple[Header, Timetable]:
    if media_type == "image/webp":
        header, timetable = animated_webp.read_chunks(path)
        check_claims(header, limits)
        return header, timetable
    with open_video(path, media_type, limits) as (container, stream):
        header = header_of(container, stream)
        check_claims(header, limits)
        return header, timetable_of(container, stream, header, limits)


def too_short() -> InputError:
    """The error for a video of one frame."""
    return InputError("video_too_short", "The video has a single frame: send a clip that moves.")
