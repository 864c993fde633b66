"""Tracked points without jitter and without lag.

A causal filter (one-euro and its kin) trades jitter for delay. A driver's clip is known whole, so each frame can look
both ways. Every position becomes the mean of those nearby in time that are also nearby in place, measured in units of
the track's own noise (a bilateral filter along time). Motion that rises above the noise, a blink of three frames
included, keeps its height and its moment.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

BLOCK_POINTS = 32
"""Points worked on at a time, so that a long clip takes little memory."""
HALF_WINDOW_FRAMES = 12
"""Frames looked at on either side."""
TEMPORAL_SIGMA = 8.0
"""Frames."""
RANGE_SIGMAS = 3.0
"""Positions further apart than about this many noise deviations are motion, not noise."""


def noise_level(tracks: NDArray[np.floating], quantile: float = 0.5) -> NDArray[np.float64]:
    """Standard deviation of each point's jitter, pixels: (N, V, D) to (V,).

    From second differences, which smooth motion hardly shows; their `quantile` keeps lively frames out: by the median
    the few, by a lower one as many as there are above it.
    """
    if len(tracks) < 5:
        return np.zeros(tracks.shape[1])
    usual = NormalDist().inv_cdf((1 + quantile) / 2) * np.sqrt(6.0)
    deviation = np.empty(tracks.shape[1:])
    for start in range(0, tracks.shape[1], BLOCK_POINTS):
        some = tracks[:, start : start + BLOCK_POINTS]
        second = some[2:] - 2 * some[1:-1] + some[:-2]
        deviation[start : start + BLOCK_POINTS] = np.quantile(np.abs(second), quantile, axis=0) / usual
    return np.asarray(np.sqrt((deviation**2).mean(axis=-1)), float)


def remove_jitter(
    tracks: NDArray[np.float32], noise: NDArray[np.floating] | None = None, out: NDArray[np.float32] | None = None
) -> NDArray[np.float32]:
    """Remove the jitter of tracked points.

    Parameters
    ----------
    tracks : (N, V, D) positions over time, pixels.
    noise : (V,) standard deviation of the jitter; measured on the tracks where not given.
    out : where the result goes; may be `tracks` themselves.

    Returns
    -------
    (N, V, D): no frame looks later or earlier than it is.
    """
    sigma = noise_level(tracks) if noise is None else noise
    if out is None:
        out = np.empty(tracks.shape, np.float32)
    for start in range(0, tracks.shape[1], BLOCK_POINTS):
        some = slice(start, start + BLOCK_POINTS)
        out[:, some] = _steady(tracks[:, some], sigma[some])
    return out


def _steady(tracks: NDArray[np.float32], sigma: NDArray[np.floating]) -> NDArray[np.float32]:
    width = 2.0 * (RANGE_SIGMAS * np.maximum(sigma, 1e-4)) ** 2
    count, reach = len(tracks), min(HALF_WINDOW_FRAMES, len(tracks) - 1)
    total = tracks.astype(np.float32).copy()
    weight = np.ones(tracks.shape[:2], np.float32)
    longer = _extended(tracks, reach)
    for lag in range(1, reach + 1):
        later, earlier = longer[reach + lag : reach + lag + count], longer[reach - lag : reach - lag + count]
        apart = np.maximum(((later - tracks) ** 2).sum(axis=-1), ((earlier - tracks) ** 2).sum(axis=-1))
        # a neighbour counts only together with its mirror image, so that steady motion is not bent
        both = np.exp(-apart / width - 0.5 * (lag / TEMPORAL_SIGMA) ** 2).astype(np.float32)
        total += both[..., None] * (later + earlier)
        weight += 2 * both
    return total / weight[..., None]


def _extended(tracks: NDArray[np.float32], reach: int) -> NDArray[np.float32]:
    """The tracks with `reach` more frames at both ends: mirrored in time, about the line that the end follows."""
    steps = np.arange(1, reach + 1, dtype=np.float32)[:, None, None]

    def before(start: NDArray[np.float32]) -> NDArray[np.float32]:
        moments = np.arange(len(start), dtype=np.float32) - np.float32((len(start) - 1) / 2)
        slope = np.tensordot(moments, start, axes=1) / max(float((moments**2).sum()), 1.0)
        return np.asarray((start[1:] - 2 * steps * slope)[::-1], np.float32)

    first, last = before(tracks[: reach + 1]), before(tracks[::-1][: reach + 1])
    return np.concatenate([first, tracks, last[::-1]])
