"""How often a surface winds about a point: one inside a closed surface, zero outside, between the two near its holes.

Source: A. Jacobson, L. Kavan, O. Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers,
SIGGRAPH 2013; the solid angle of a triangle by A. van Oosterom, J. Strackee, The solid angle of a plane triangle, IEEE
Trans. Biomed. Eng. 30, 1983.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit


def winding_numbers(
    points: NDArray[np.floating], vertices: NDArray[np.floating], triangles: NDArray[np.integer]
) -> NDArray[np.float64]:
    """(N,) of the surface `triangles` (T, 3) over `vertices` (V, 3), counter-clockwise from outside, about `points` (N, 3)."""
    corners = np.ascontiguousarray(np.asarray(vertices, np.float64)[triangles])
    return np.asarray(_winding(np.ascontiguousarray(points, np.float64), corners))


@njit(parallel=True, nogil=True, boundscheck=False, error_model="numpy")
def _winding(points, corners):  # type: ignore[no-untyped-def]
    out = np.zeros(len(points))
    for n in prange(len(points)):
        total = 0.0
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        for t in range(len(corners)):
            ax, ay, az = corners[t, 0, 0] - x, corners[t, 0, 1] - y, corners[t, 0, 2] - z
            bx, by, bz = corners[t, 1, 0] - x, corners[t, 1, 1] - y, corners[t, 1, 2] - z
            cx, cy, cz = corners[t, 2, 0] - x, corners[t, 2, 1] - y, corners[t, 2, 2] - z
            la = np.sqrt(ax * ax + ay * ay + az * az)
            lb = np.sqrt(bx * bx + by * by + bz * bz)
            lc = np.sqrt(cx * cx + cy * cy + cz * cz)
            volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
            ab, bc, ca = ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz, cx * ax + cy * ay + cz * az
            total += np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
        out[n] = total / (2 * np.pi)
    return out
