"""Which of the skin about a closed mouth is of the upper lip, and which of the lower, outside and within."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from engine.geometry.mesh.adjacency import edges

LIP_REACH_METRES = 0.02
"""Metres along the surface from where lips touch up to which skin is of one of them."""


def lip_sides(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    upper: NDArray[np.integer],
    lower: NDArray[np.integer],
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(S,) and (S,) the skin of the `upper` and of the `lower` lip, of each of which vertices are given that touch the other lip.

    `vertices` (S, 3) metres, `triangles` (T, 3). Nearness is along the surface: behind lips that touch, the inside of one may lie
    nearer to the other."""
    joined = edges(triangles)
    lengths = np.linalg.norm(vertices[joined[:, 0]] - vertices[joined[:, 1]], axis=1)
    graph = sp.csr_array((lengths, (joined[:, 0], joined[:, 1])), (len(vertices), len(vertices)))
    away = [
        dijkstra(graph, directed=False, indices=seeds, min_only=True, limit=LIP_REACH_METRES)
        for seeds in (upper, lower)
    ]
    near = [np.isfinite(one) for one in away]
    return np.asarray(near[0] & (away[0] <= away[1])), np.asarray(near[1] & (away[1] < away[0]))
