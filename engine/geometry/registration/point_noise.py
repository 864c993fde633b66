"""How far points of a cloud are off a surface that lies among them, place by place: what is measured badly is to count less.

Least squares in which each observation counts by the inverse of its own variance, which the residuals of a first fit tell: R. J.
Carroll, D. Ruppert, Transformation and Weighting in Regression, Chapman and Hall 1988, chapter 2.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.closest_points import closest_points
from engine.geometry.mesh.surface import vertex_normals

SURFACE_REACH_METRES = 0.03
"""Metres from the surface within which points are of it."""
CONTRADICTION_METRES = 0.01
"""Metres by which a point is off, at least, that faces another way than the surface does."""
VARIANCE_SMOOTHING_RINGS = 2
"""Rings of vertices over which variances are taken together."""


def point_noise(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    min_cosine: float,
) -> NDArray[np.float64]:
    """(V,) metres by which the points (N, 3) about each of the `vertices` (V, 3) are off the surface of `triangles` (T, 3), root mean
    square; `SURFACE_REACH_METRES` where there are none.

    A point whose normal (N, 3) makes with the surface's an angle of a lesser cosine than `min_cosine` contradicts it.
    """
    count = len(vertices)
    nearest = closest_points(points, vertices, triangles)
    corners, shares = np.asarray(triangles)[nearest.triangle], nearest.barycentrics
    own = vertex_normals(vertices, triangles)[corners]
    facing = np.einsum("nk,nkc,nc->n", shares, own, normals) > min_cosine
    off = np.where(facing, nearest.distance, np.maximum(nearest.distance, CONTRADICTION_METRES))
    near = nearest.distance < SURFACE_REACH_METRES
    places, weights = corners[near].ravel(), shares[near].ravel()
    squares = np.bincount(places, weights * (off[near] ** 2).repeat(3), count)
    number = np.bincount(places, weights, count)
    around = neighbours(np.asarray(triangles), count)
    around = sp.csr_array(around + sp.eye_array(count))
    for _ in range(VARIANCE_SMOOTHING_RINGS):
        squares, number = around @ squares, around @ number
    return np.asarray(np.where(number > 0, np.sqrt(squares / np.maximum(number, 1e-12)), SURFACE_REACH_METRES))
