"""Where a warped picture folds over itself, two parts of it meet that are no neighbours: the edge gets steps, which a
drawn outline would not have. They are smoothed there, and nowhere else."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


def smooth_folds(
    frame: NDArray[np.uint8],
    origin: NDArray[np.float32],
    jump: float,
    moved: NDArray[np.float32],
    triangles: NDArray[np.int32],
) -> None:
    """Blend the pixels on both sides of each fold with their neighbours (3x3 binomial), in place.

    Parameters
    ----------
    frame : (H, W, 3) uint8, a picture warped by `origin` (H, W, 2), its inverse map.
    jump : pixels of the source by which the origins of two neighbours differ at a fold: more than where it is only
    squeezed.
    moved, triangles : the mesh (V, 2), (T, 3) that made the map; where it folds, triangles lie face down.
    """
    height, width = frame.shape[:2]
    left, top, right, bottom = folded_box(moved, triangles, (height, width))
    left, top, right, bottom = max(left, 1), max(top, 1), min(right, width - 1), min(bottom, height - 1)
    if left < right and top < bottom:
        _smooth(frame, frame[top - 1 : bottom + 1, left - 1 : right + 1].copy(), origin, left, top, np.float32(jump))


def folded_box(
    moved: NDArray[np.float32], triangles: NDArray[np.int32], shape: tuple[int, int]
) -> tuple[int, int, int, int]:
    """The box (left, top, right, bottom) of the pixels of a picture (height, width) where a mesh (V, 2), (T, 3) folds
    over itself; right of left and below the top none if it does not. It is one sheet whose border stays: where it lies
    double, a triangle lies face down."""
    low, high = _face_down(moved, triangles)
    left, top = np.clip(low, 0, shape[::-1]).astype(int).tolist()
    right, bottom = np.clip(high + 2, 0, shape[::-1]).astype(int).tolist()
    return left, top, right, bottom


@njit(fastmath=True, nogil=True)
def _face_down(moved, triangles):  # type: ignore[no-untyped-def]
    """The box (left, top), (right, bottom) around the triangles that are turned over; right of left none if there are none."""
    area, whole = np.zeros(len(triangles), np.float32), np.float32(0)
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        across = (moved[b, 0] - moved[a, 0]) * (moved[c, 1] - moved[a, 1])
        area[t] = across - (moved[b, 1] - moved[a, 1]) * (moved[c, 0] - moved[a, 0])
        whole += area[t]
    low, high = np.full(2, np.float32(1e9)), np.full(2, np.float32(-1e9))
    for t in range(len(triangles)):
        if whole * area[t] < 0:
            for v in triangles[t]:
                for k in range(2):
                    low[k], high[k] = min(low[k], moved[v, k]), max(high[k], moved[v, k])
    return low, high


@njit(fastmath=True, nogil=True)
def _smooth(frame, before, origin, left, top, jump):  # type: ignore[no-untyped-def]
    """`before` is a copy of the frame from one pixel left of and above (left, top) on."""
    for row in range(1, before.shape[0] - 1):
        for column in range(1, before.shape[1] - 1):
            y, x = top + row - 1, left + column - 1
            away = np.float32(0)
            for k in range(2):
                for there in (origin[y, x + 1], origin[y, x - 1], origin[y + 1, x], origin[y - 1, x]):
                    away = max(away, abs(there[k] - origin[y, x, k]))
            if away <= jump:
                continue
            for c in range(3):
                total = 4 * np.int32(before[row, column, c])
                for step in (-1, 1):
                    total += 2 * (np.int32(before[row + step, column, c]) + np.int32(before[row, column + step, c]))
                    total += np.int32(before[row + step, column - 1, c]) + np.int32(before[row + step, column + 1, c])
                frame[y, x, c] = (total + 8) // 16
