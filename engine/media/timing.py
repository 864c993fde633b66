"""From timestamps to a constant rate: what the rate of a clip is, and which frame is shown when."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import TypeVar

import numpy as np

Shown = TypeVar("Shown")

_COMMON_RATES = (5, 6, 8, 10, 12, 12.5, 15, 20, 24000 / 1001, 24, 25, 30000 / 1001, 30, 48, 50, 60000 / 1001, 60)
_JITTER = 0.35
"""Of a frame: timestamps this near to an even grid are a constant rate. Milliseconds (Matroska) and hundredths (GIF)
round by less; half a frame would be ambiguous."""


def constant_rate(times: np.ndarray, candidates: Iterable[float]) -> float | None:
    """The first rate of `candidates` (1/s), or else the mean rate, whose even grid the `times` (n,) s keep to."""
    if len(times) < 2:
        return next(iter(candidates), None)
    mean = (len(times) - 1) / (times[-1] - times[0])
    for rate in (*candidates, mean):
        places = (times - times[0]) * rate
        if np.abs(places - np.arange(len(times)) - np.median(places - np.arange(len(times)))).max() < _JITTER:
            return float(rate)
    return None


def nominal_rate(times: np.ndarray) -> float:
    """A usual rate for a clip of variable rate: the smallest that loses (almost) no frames of the mean rate."""
    mean = (len(times) - 1) / max(times[-1] - times[0], 1e-6)
    return float(next((rate for rate in _COMMON_RATES if rate >= 0.97 * mean), _COMMON_RATES[-1]))


def exact_rate(fps: float) -> Fraction:
    """A rate in frames a second as a fraction; 29.97 and its kin become n * 1000/1001."""
    ntsc = Fraction(round(fps * 1.001) * 1000, 1001)
    return ntsc if abs(float(ntsc) - fps) < 5e-4 * fps and round(fps) != fps else Fraction(fps).limit_denominator(1000)


def resample(
    frames: Iterable[tuple[float, Shown]], fps: float, start: float, last: float
) -> Iterator[tuple[float, Shown]]:
    """Frames at constant rate: the k-th is the one on show at the middle of its span, `start + (k + 1/2) / fps`.

    Taking the middle is without lag, and gives a clip that already has this rate back unchanged, frame by frame.

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
    end = held[0] + last
    while start + (made + 0.5) / fps < end:
        yield start + made / fps, held[1]
        made += 1
