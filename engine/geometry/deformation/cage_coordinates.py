"""Points inside a closed surface as weighted means of its vertices, to follow it as it deforms.

Source: T. Ju, S. Schaefer, J. Warren, Mean value coordinates for closed triangular meshes, SIGGRAPH 2005 (figure 4).
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit

COINCIDENT = 1e-9
"""Radians, and shares of a length, below which a point lies on the surface, or in a triangle's plane."""


def cage_coordinates(
    points: NDArray[np.floating], vertices: NDArray[np.floating], triangles: NDArray[np.integer]
) -> NDArray[np.float64]:
    """(N, V): the weights of the vertices (V, 3) of the closed surface `triangles` (T, 3) that give `points` (N, 3).

    Each row sums to one and times the vertices gives its point. Outside of the surface, and where it is far from convex,
    some weights are negative.
    """
    return np.asarray(
        _coordinates(
            np.ascontiguousarray(points, np.float64),
            np.ascontiguousarray(vertices, np.float64),
            np.ascontiguousarray(triangles, np.int64),
        )
    )


@njit(parallel=True, nogil=True, error_model="numpy")
def _coordinates(points, vertices, triangles):  # type: ignore[no-untyped-def]
    out = np.zeros((len(points), len(vertices)))
    for n in prange(len(points)):
        away = vertices - points[n]
        length = np.sqrt((away**2).sum(1))
        at = np.argmin(length)
        if length[at] < COINCIDENT:
            out[n, at] = 1
            continue
        unit = away / length.reshape(-1, 1)
        weights = np.zeros(len(vertices))
        for t in range(len(triangles)):
            if _add_triangle(triangles[t], unit, length, weights):  # the point lies in this triangle
                break
        out[n] = weights / weights.sum()
    return out


@njit(nogil=True, error_model="numpy")
def _add_triangle(corners, unit, length, weights):  # type: ignore[no-untyped-def]
    """Add the weights of a triangle's corners; where the point lies in it, they are all there is, and True is returned."""
    angle, sine = np.empty(3), np.empty(3)
    for k in range(3):
        chord = unit[corners[(k + 1) % 3]] - unit[corners[(k + 2) % 3]]
        angle[k] = 2 * np.arcsin(min(np.sqrt((chord**2).sum()) / 2, 1.0))
    half = angle.sum() / 2
    if np.pi - half < COINCIDENT:
        weights[:] = 0
        for k in range(3):
            one, other = corners[(k + 1) % 3], corners[(k + 2) % 3]
            weights[corners[k]] = np.sin(angle[k]) * length[one] * length[other]
        return True
    a, b, c = unit[corners[0]], unit[corners[1]], unit[corners[2]]
    volume = (a * np.cross(b, c)).sum()
    sign = 1.0 if volume > 0 else -1.0
    cosine = np.empty(3)
    for k in range(3):
        one, other = angle[(k + 1) % 3], angle[(k + 2) % 3]
        cosine[k] = 2 * np.sin(half) * np.sin(half - angle[k]) / (np.sin(one) * np.sin(other)) - 1
        sine[k] = sign * np.sqrt(max(1 - cosine[k] ** 2, 0.0))
        if abs(sine[k]) < COINCIDENT or not np.isfinite(sine[k]):
            return False  # the point lies in the plane, outside of the triangle
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        spread = length[corners[k]] * np.sin(angle[i]) * sine[j]
        weights[corners[k]] += (angle[k] - cosine[i] * angle[j] - cosine[j] * angle[i]) / spread
    return False
