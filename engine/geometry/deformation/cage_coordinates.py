"""Points inside a closed surface as weighted means of its vertices, to follow it as it deforms.

Source: T. Ju, S. Schaefer, J. Warren, Mean value coordinates for closed triangular meshes, SIGGRAPH 2005 (figure 4).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

NEXT_CORNER, LAST_CORNER = [1, 2, 0], [2, 0, 1]
"""For each corner of a triangle the other two."""
COINCIDENCE_TOLERANCE = 1e-9
"""Radians, and shares of a length, below which a point lies on the surface, or in a triangle's plane."""


def cage_coordinates(
    points: NDArray[np.floating], vertices: NDArray[np.floating], triangles: NDArray[np.integer]
) -> NDArray[np.float64]:
    """(N, V): the weights of the vertices (V, 3) of the closed surface `triangles` (T, 3) that give `points` (N, 3).

    Each row sums to one and times the vertices gives its point. Outside of the surface, and where it is far from convex,
    some weights are negative.
    """
    corners = np.asarray(triangles)
    placed = np.asarray(vertices, np.float64)
    found = [_weights(placed - point, corners) for point in np.asarray(points, np.float64)]
    return np.array(found).reshape(len(points), len(placed))


def _weights(away: NDArray[np.float64], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
    """(V,): the weights of vertices that lie `away` (V, 3) from the point."""
    length = np.linalg.norm(away, axis=1)
    at = int(np.argmin(length))
    weights = np.zeros(len(away))
    if length[at] < COINCIDENCE_TOLERANCE:
        weights[at] = 1
        return weights
    units = (away / length[:, None])[triangles]
    chord = np.linalg.norm(units[:, NEXT_CORNER] - units[:, LAST_CORNER], axis=2)
    angle = 2 * np.arcsin(np.minimum(chord / 2, 1))
    half = angle.sum(1) / 2
    around = np.flatnonzero(np.pi - half < COINCIDENCE_TOLERANCE)
    if len(around):  # the point lies in this triangle
        corners = triangles[around[0]]
        weights[corners] = np.sin(angle[around[0]]) * length[corners[NEXT_CORNER]] * length[corners[LAST_CORNER]]
        return weights / weights.sum()
    volume = np.einsum("tc,tc->t", units[:, 0], np.cross(units[:, 1], units[:, 2]))
    sine = np.sin(angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (
            2 * (np.sin(half)[:, None] * np.sin(half[:, None] - angle)) / (sine[:, NEXT_CORNER] * sine[:, LAST_CORNER])
            - 1
        )
        steep = np.where(volume > 0, 1, -1)[:, None] * np.sqrt(np.maximum(1 - cosine**2, 0))
        added = angle - cosine[:, NEXT_CORNER] * angle[:, LAST_CORNER] - cosine[:, LAST_CORNER] * angle[:, NEXT_CORNER]
        added = added / (length[triangles] * sine[:, NEXT_CORNER] * steep[:, LAST_CORNER])
    counted = (np.abs(steep) >= COINCIDENCE_TOLERANCE).all(
        1
    )  # of others the point lies in the plane, outside of the triangle
    np.add.at(weights, triangles[counted], added[counted])
    return np.asarray(weights / weights.sum())
