"""A smooth shift of a picture's places, by a lattice of nodes between which it is bilinear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


@dataclass(frozen=True)
class ImageShift:
    """`nodes` (rows, columns, 2): by how many pixels, x and y, places are shifted at the nodes of a lattice whose first is the
    centre of the top-left pixel; `spacing` pixels lie between two. It reaches over the whole picture, and goes on beyond."""

    nodes: NDArray[np.float32]
    spacing: float

    @staticmethod
    def none(size: tuple[int, int], spacing: float) -> ImageShift:
        """No shift yet, of a picture of a `size` (height, width)."""
        rows, columns = (int(np.ceil((side - 1) / spacing)) + 1 for side in size)
        return ImageShift(np.zeros((max(rows, 2), max(columns, 2), 2), np.float32), spacing)

    def finer(self, size: tuple[int, int], spacing: float) -> ImageShift:
        """This shift on another lattice, of a picture of a `size` (height, width)."""
        other = ImageShift.none(size, spacing)
        rows, columns = other.nodes.shape[:2]
        y, x = np.meshgrid(np.arange(rows) * spacing, np.arange(columns) * spacing, indexing="ij")
        at = np.stack([x.ravel(), y.ravel()], 1).astype(np.float32)
        return ImageShift((self.shifted(at) - at).reshape(rows, columns, 2), spacing)

    def scaled(self, factor: float) -> ImageShift:
        """This shift as it is of the picture resized by `factor`."""
        return ImageShift(self.nodes * np.float32(factor), self.spacing * factor)

    def shifted(self, pixels: NDArray[np.floating]) -> NDArray[np.float32]:
        """Pixels (N, 2 or 3), x and y first, where the shift takes them; what stands behind stays."""
        return np.asarray(_shifted(self.nodes, self.spacing, np.ascontiguousarray(pixels, np.float32)))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def lattice_cell(x: float, y: float, spacing: float, rows: int, columns: int) -> tuple[int, int, float, float]:
    """The row and column of the node before a place, and how far on it is towards the next ones, as shares of a cell."""
    across = min(max(x / spacing, 0.0), columns - 1.0)
    down = min(max(y / spacing, 0.0), rows - 1.0)
    column, row = min(int(across), columns - 2), min(int(down), rows - 2)
    return row, column, across - column, down - row


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _shifted(nodes: np.ndarray, spacing: float, pixels: np.ndarray) -> np.ndarray:
    out = pixels.copy()
    rows, columns = nodes.shape[:2]
    for n in range(len(pixels)):
        x, y = pixels[n, 0], pixels[n, 1]
        if not (abs(x) < 1e9 and abs(y) < 1e9):  # NaN, or next to the plane of the lens
            continue
        row, column, right, down = lattice_cell(x, y, spacing, rows, columns)
        for k in range(2):
            above = nodes[row, column, k] * (1 - right) + nodes[row, column + 1, k] * right
            below = nodes[row + 1, column, k] * (1 - right) + nodes[row + 1, column + 1, k] * right
            out[n, k] += above * (1 - down) + below * down
    return out
