"""Random detail at several scales, over pictures and in space."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

LATTICE_CELLS = 32
"""Cells along the side of the random lattice that fills space again and again."""


def picture_noise(
    size: tuple[int, int], cells: tuple[float, ...], random: np.random.Generator, channels: int = 1
) -> NDArray[np.float32]:
    """(height, width, channels) float32 of about unit spread: for each of `cells`, texels wide, smooth noise of that size."""
    total = np.zeros((*size, channels), np.float32)
    for cell in cells:
        rows, columns = (max(2, round(side / cell)) for side in size)
        coarse = random.standard_normal((rows, columns, channels)).astype(np.float32)
        total += cv2.resize(coarse, size[::-1], interpolation=cv2.INTER_CUBIC).reshape(total.shape)
    return total / np.float32(np.sqrt(len(cells)))


def space_noise(
    points: NDArray[np.floating], cells: tuple[float, ...], random: np.random.Generator
) -> NDArray[np.float32]:
    """(N,) float32 of about unit spread at points (N, 3): the same with cells in the points' unit; it repeats after
    `LATTICE_CELLS` cells."""
    total = np.zeros(len(points), np.float32)
    for cell in cells:
        lattice = random.standard_normal((LATTICE_CELLS, LATTICE_CELLS, LATTICE_CELLS)).astype(np.float32)
        at = np.asarray(points, np.float32).T / np.float32(cell)
        total += map_coordinates(lattice, at, order=1, mode="grid-wrap")
    return total * np.float32(1.5 / np.sqrt(len(cells)))  # what is interpolated linearly spreads less
