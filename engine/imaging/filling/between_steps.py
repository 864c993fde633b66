"""Rows of colours smoothed between steps: what goes round something begins and ends at one height on all of its sides."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d


def steps_of_all(values: NDArray[np.floating], sure: NDArray[np.bool_], window: int, least: float) -> NDArray[np.intp]:
    """The rows at which all columns of `values` (A, S, C) that are `sure` (A, S) step alike, by `least` or more: means of `window` rows
    before and after are compared, and of steps as near as that to one another the largest is told."""
    count = len(values)
    total = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, 0, dtype=np.float64)])
    row = np.arange(1, count)
    first, last = np.maximum(row - window, 0), np.minimum(row + window, count)
    before = (total[row] - total[first]) / (row - first)[:, None, None]
    after = (total[last] - total[row]) / (last - row)[:, None, None]
    change = after - before
    told = sure[1:] & sure[:-1]
    mean = (change * told[..., None]).sum(1) / np.maximum(told.sum(1), 1)[:, None]
    length = np.linalg.norm(mean, axis=-1)
    along = np.einsum("asc,ac->as", change, mean) / np.maximum(length, 1e-6)[:, None]
    strength = np.where(told.any(1), np.where(told, along, np.inf).min(1), 0)
    largest = maximum_filter1d(strength, 2 * window + 1, mode="nearest")
    return np.asarray(row[(strength >= max(least, 1e-6)) & (strength == largest)], np.intp)


def smoothed_between(
    values: NDArray[np.floating], steps: NDArray[np.integer], sigma: float, soft: int = 0
) -> NDArray[np.float32]:
    """Values (A, ...) averaged over rows, `sigma` as a standard deviation, but over none of the `steps` (N,). The `soft` rows on either side of a
    step, in which both are mixed, do not count: they are as the next ones."""
    ends = [0, *steps.tolist(), len(values)]
    pieces = []
    for first, last in pairwise(ends):
        stepped = (first > 0, last < len(values))
        margin = min(soft, (last - first - 1) // max(sum(stepped), 1))
        before, after = (margin * side for side in stepped)
        piece = np.asarray(values[first + before : last - after], np.float32)
        smooth = gaussian_filter1d(piece, sigma, axis=0, mode="reflect")
        pieces.append(np.pad(smooth, ((before, after), *[(0, 0)] * (smooth.ndim - 1)), mode="edge"))
    return np.concatenate(pieces)
