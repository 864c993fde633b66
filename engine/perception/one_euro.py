"""Points followed live, steadied by what came before alone: the one-euro filter.

Casiez, Roussel and Vogel: 1 € Filter: A Simple Speed-based Low-pass Filter for Noisy Input in Interactive Systems (CHI 2012).
A point at rest is averaged over many frames, one that moves over few: jitter is seen at rest, delay in motion. Where a clip
is known whole, `engine.perception.temporal_filter` does better: it looks both ways.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


class OneEuroFilter:
    """Steadies points, one call for each moment.

    Parameters
    ----------
    min_cutoff : Hz, at rest. beta : by how many Hz the cutoff rises for each unit a second. derivative_cutoff : Hz, of the
    speed itself.
    """

    def __init__(self, min_cutoff: float, beta: float, derivative_cutoff: float):
        self._min_cutoff, self._beta, self._derivative_cutoff = min_cutoff, beta, derivative_cutoff
        self._last: NDArray[np.float64] | None = None
        self._speed = np.zeros(0)
        self._time = 0.0

    def __call__(self, points: NDArray[np.floating], time: float) -> NDArray[np.float64]:
        """The points (V, D) of a moment, `time` in seconds, steadied. A moment that is not after the last one changes
        nothing."""
        points = np.asarray(points, float)
        if self._last is None:
            self._last, self._speed, self._time = np.array(points, float), np.zeros(points.shape), time
            return self._last
        span = time - self._time
        if span > 0:
            share = _share(np.asarray(self._derivative_cutoff), span)
            self._speed = self._speed + share * ((points - self._last) / span - self._speed)
            cutoff = self._min_cutoff + self._beta * np.linalg.norm(self._speed, axis=1, keepdims=True)
            self._last = self._last + _share(cutoff, span) * (points - self._last)
            self._time = time
        return self._last


def _share(cutoff: NDArray[np.floating], span: float) -> NDArray[np.float64]:
    """How far an average of this cutoff (Hz) goes towards what is new after `span` seconds (the paper's equation 6)."""
    rate = 2 * np.pi * cutoff * span
    return np.asarray(rate / (rate + 1), float)
