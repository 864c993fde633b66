"""Values over time, drawn through a few keys."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

Array = NDArray[np.float64]

Keys = Sequence[tuple[float, float]]


def periodic_curve(phase: ArrayLike, keys: Keys) -> Array:
    """A curve of period 1 through (phase, value) keys, phases ascending in [0, 1); it does not overshoot its keys."""
    times, values = np.array(keys, np.float64).T
    around = np.concatenate([times + turn for turn in (-2, -1, 0, 1, 2)])
    return np.asarray(PchipInterpolator(around, np.tile(values, 5))(np.asarray(phase) % 1.0))


def curve_through(time: ArrayLike, keys: Keys) -> Array:
    """A curve through (time, value) keys, level before the first and after the last; it does not overshoot them."""
    times, values = np.array(keys, np.float64).T
    times = np.concatenate([[times[0] - 1], times, [times[-1] + 1]])
    values = np.concatenate([values[:1], values, values[-1:]])
    return np.asarray(PchipInterpolator(times, values)(np.clip(time, times[0], times[-1])))


def hermite_curve(time: ArrayLike, keys: Sequence[tuple[float, float, float]]) -> Array:
    """A curve through (time, value, speed) keys, level before the first and after the last."""
    times, values, speeds = np.array(keys, np.float64).T
    return np.asarray(CubicHermiteSpline(times, values, speeds)(np.clip(time, times[0], times[-1])))


def ease(share: ArrayLike) -> Array:
    """From 0 to 1 with no speed at either end, level outside."""
    u = np.clip(np.asarray(share, np.float64), 0, 1)
    return np.asarray(u * u * u * (u * (6 * u - 15) + 10))
