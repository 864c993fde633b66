"""Frames out of a demuxed file, in the order of showing, each with its time; damage is counted, not fatal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf
from pathlib import Path

import av
from av.container import InputContainer
from av.video.frame import VideoFrame
from av.video.stream import VideoStream

from engine.media.decoding import animated_webp
from engine.media.decoding.demux import Timetable, open_video
from engine.media.limits import Limits


@dataclass
class Damage:
    """What went wrong so far: `errors` parts that did not decode, `frames` that did, and after how many of them the
    last error came."""

    errors: int = 0
    frames: int = 0
    last_error: int = 0

    def note(self) -> None:
        """Count an error."""
        self.errors += 1
        self.last_error = self.frames


def decode(
    path: Path, media_type: str, timetable: Timetable, limits: Limits, start: float, damage: Damage
) -> Iterator[tuple[float, VideoFrame]]:
    """(seconds since the timetable's first time, frame), from `start` seconds or earlier on.

    Where the file has an index, what comes long before `start` is skipped. What goes wrong is counted in `damage`.
    """
    if media_type == "image/webp":
        for time, frame in animated_webp.decode(path, timetable):
            damage.frames += 1
            yield time, frame
        return
    origin = float(timetable.times[0])
    for seek in (True, False) if start > 1 else (False,):
        with open_video(path, media_type, limits) as (container, stream):
            if seek and not _seek(container, stream, origin + start):
                continue
            frames = _frames(container, stream, timetable, inf if seek else 0.0, damage)
            first = next(frames, None)
            if seek and (first is None or first[0] > start):
                continue  # the index was wrong, or there is none
            if first is not None:
                yield first
                yield from frames
            return


def _seek(container: InputContainer, stream: VideoStream, seconds: float) -> bool:
    if not stream.time_base:
        return False
    try:
        container.seek(int(seconds / stream.time_base), stream=stream, backward=True)
    except av.FFmpegError:
        return False
    return True


def _frames(
    container: InputContainer, stream: VideoStream, timetable: Timetable, earliest: float, damage: Damage
) -> Iterator[tuple[float, VideoFrame]]:
    """`earliest` is the time of a first frame that has none of its own."""
    origin, step = float(timetable.times[0]), timetable.step
    packets = container.demux(stream)
    latest = earliest - step
    # AVI says when frames are decoded, not when they are shown: they are shown in the order in which they come out.
    without_times = container.format.name == "avi"
    flushed = False
    while not flushed:
        try:
            packet = next(packets, None)
        except av.FFmpegError:
            damage.note()
            packet = None
        flushed = packet is None or packet.size == 0
        try:
            frames = stream.decode(packet)
        except av.FFmpegError:
            damage.note()
            continue
        for frame in frames:
            if frame.is_corrupt:
                damage.note()
                latest += step if without_times else 0.0
                continue
            damage.frames += 1
            clock = frame.time_base or stream.time_base  # frames that come out last have no clock of their own
            if without_times or frame.pts is None or not clock:
                latest += step
            else:
                time = float(frame.pts * clock) - origin
                latest = time if latest == inf else max(time, latest)
            yield latest, frame
