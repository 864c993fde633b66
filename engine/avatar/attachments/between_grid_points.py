"""A smooth function over a grid, asked at an eighth of its points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

SMOOTH_STEP = 2
"""Grid points between those at which a smooth function is asked."""


def between_grid_points(
    cells: NDArray[np.integer], smooth: Callable[[NDArray[np.float64]], NDArray[np.floating]]
) -> NDArray[np.float64]:
    """(M,) what a `smooth` function, of places (N, 3) in grid points, says at the `cells` (M, 3), none negative. It is asked at every
    `SMOOTH_STEP`th along each axis about these, and interpolated linearly between."""
    if not len(cells):
        return np.zeros(0)
    coarse = np.asarray(cells) / SMOOTH_STEP
    asked = np.zeros(np.ceil(coarse.max(0)).astype(int) + 1, np.bool_)
    for corner in np.ndindex(2, 2, 2):
        beside = np.where(corner, np.ceil(coarse), np.floor(coarse)).astype(int)
        asked[tuple(beside.T)] = True
    said = np.zeros(asked.shape)
    said[asked] = smooth(SMOOTH_STEP * np.argwhere(asked).astype(np.float64))
    return np.asarray(ndimage.map_coordinates(said, coarse.T, order=1))
