"""From timestamps to a constant rate: the rate of a clip, and which frame is on show when."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

import numpy as np

Shown = TypeVar("Shown")

_USUAL_RATES = (5, 6, 8, 10, 12, 15, 20, 24, 25, 30, 48, 50, 60)
_MAX_JITTER_FRAMES = 0.35
"""Of a frame: timestamps this near to an even grid are a constant rate. Files round them to milliseconds (Matroska) or
hundredths (GIF), phones let them tremble a little; at half a frame the place on the grid would be ambiguous."""
_SHORTEST_STEP = 1e-9
"""Seconds: timestamps that lie closer, or of which rounding leaves no order, are of no clock."""

MIN_SPAN_SECONDS = 1e-3
"""Seconds for which a frame is on show at least; of those that are not, nobody sees anything."""

_MIN_FPS = 1.0
"""Frames a second: a slower clip is a row of stills, whose rate is made up."""

_RATE_SPAN_FRAMES = 16
"""Frames: a changing rate is measured over so many at once (over a quarter of a clip that has few), in which the
trembling of single timestamps is lost."""
_MAX_FASTER_SHARE = 0.1
"""Share of a clip of changing rate that may be faster than the rate it is given."""

_MAX_MISSING_SHARE = 0.1
"""Share of frames that may be missing on the grid (dropped by the camera, lost with a broken tail)."""


@dataclass(frozen=True)
class Rate:
    """Frames a second of a clip. Where they are `constant`, the frames lie on a grid, `phase + k / fps` seconds after
    the first timestamp (a few may be missing); else `fps` is a usual rate that hardly loses a frame."""

    fps: float
    phase: float
    constant: bool


def rate_of(times: np.ndarray, stated: Iterable[float] = ()) -> Rate:
    """The rate of a clip by its timestamps.

    Parameters
    ----------
    times : (n,) seconds, ascending, n >= 2.
    stated : rates that the file's header claims; the first one that the timestamps keep to is taken, else the rate of
        the straight line through them.
    """
    count = len(times)
    slope = max(float(np.polyfit(np.arange(count), times, 1)[0]), _SHORTEST_STEP)
    whole = [float(round(1 / slope))] if abs(round(1 / slope) * slope - 1) < 5e-4 else []  # rounded timestamps
    rates = [fps for fps in (*stated, *whole, 1 / slope) if fps >= _MIN_FPS]
    for holes in (False, True):  # a rate at which none is missing comes first: headers may guess a quicker one
        for fps in rates:
            even = (times - times[0]) * fps
            places = np.round(even) if holes else np.arange(count)
            offsets = even - places
            if (
                np.ptp(offsets) / 2 < _MAX_JITTER_FRAMES
                and np.diff(places).min() >= 1
                and places[-1] < count * (1 + _MAX_MISSING_SHARE)
            ):
                return Rate(float(fps), float((offsets.max() + offsets.min()) / 2 / fps), True)
    span = max(1, min(_RATE_SPAN_FRAMES, count // 4))
    quick = span / max(float(np.quantile(times[span:] - times[:-span], _MAX_FASTER_SHARE)), _SHORTEST_STEP)
    usual = next((rate for rate in _USUAL_RATES if rate >= 0.95 * quick), _USUAL_RATES[-1])
    return Rate(float(usual), 0.0, False)


def without_echoes(times: np.ndarray) -> np.ndarray:
    """The timestamps without those that follow the one before within a quarter of the usual step.

    Hidden reference frames (VP8) are packets of their own, a tick away from the frame that is shown.
    """
    times = np.unique(times)
    if len(times) < 3:
        return times
    steps = np.diff(times)
    return times[np.concatenate([[True], steps > 0.25 * np.median(steps)])]


def exact_rate(fps: float) -> Fraction:
    """Frames a second as a fraction; 23.976, 29.97 and 59.94 become n * 1000/1001."""
    ntsc = Fraction(round(fps * 1.001) * 1000, 1001)
    near = abs(float(ntsc) - fps) < 5e-4 and abs(round(fps) - fps) > 5e-4
    return ntsc if near else Fraction(fps).limit_denominator(1000)


def at_own_times(frames: Iterable[tuple[float, Shown]], start: float) -> Iterator[tuple[float, Shown]]:
    """Frames in order with the time (seconds) at which each comes on show, from the one on show at `start` on, whose time
    that is. Of frames of the same moment, the last is shown."""
    held: tuple[float, Shown] | None = None
    for time, frame in frames:
        if held is None:
            held = max(time, start), frame
        elif time > held[0] + MIN_SPAN_SECONDS:
            yield held
            held = time, frame
        else:
            held = held[0], frame
    if held is not None:
        yield held


def resample(
    frames: Iterable[tuple[float, Shown]], fps: float, start: float, last: float
) -> Iterator[tuple[float, Shown]]:
    """Frames at constant rate: the k-th is the one on show at the middle of its span, `start + (k + 1/2) / fps`.

    Taking the middle is without lag, and gives a clip that has this rate back unchanged, frame by frame.

    Parameters
    ----------
    frames : (time in seconds, frame) in order.
    fps : frames a second to make.
    start : seconds; the time of the first frame made.
    last : seconds that the last frame stays on show.

    Yields (time in seconds, frame); one frame may come more than once.
    """
    made = 0
    held: tuple[float, Shown] | None = None
    for time, frame in frames:
        while held is not None and start + (made + 0.5) / fps < time:
            yield start + made / fps, held[1]
            made += 1
        held = (time, frame)
    if held is None:
        return
    while start + (made + 0.5) / fps < held[0] + last:
        yield start + made / fps, held[1]
        made += 1
