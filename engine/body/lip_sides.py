"""Which of the skin about a closed mouth is of the upper lip, and which of the lower, outside and within."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components, dijkstra

from engine.geometry.mesh.adjacency import edge_table, edges

LIP_REACH_METRES = 0.02
"""Metres along the surface from the rims of the lips up to which skin is of one of them."""


def lip_rims(
    vertices: NDArray[np.floating], triangles: NDArray[np.integer], within: NDArray[np.bool_]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The vertices of the rim of the upper and of the lower lip, where the mouth's inside begins: all of that loop but its corners,
    which are of both.

    `vertices` (V, 3) with x across and y up, `triangles` (T, 3), of which those `within` (T,) are the mouth's inside. How far the jaw
    takes skin along does not tell which lip it is of: at the corners it takes both.
    """
    table = edge_table(np.ascontiguousarray(triangles, np.int32), np.arange(len(vertices), dtype=np.int32))
    table = table[table[:, 3] >= 0]
    rim = table[within[table[:, 2]] != within[table[:, 3]], :2]
    loop = np.unique(rim)
    across = vertices[loop, 0]
    corners = loop[[across.argmin(), across.argmax()]]
    kept = rim[~np.isin(rim, corners).any(1)]
    links = sp.csr_array((np.ones(len(kept)), (kept[:, 0], kept[:, 1])), (len(vertices), len(vertices)))
    piece = connected_components(links, directed=False)[1]
    arcs = [loop[piece[loop] == number] for number in np.unique(piece[kept])]
    upper, lower = sorted(arcs, key=lambda arc: -float(vertices[arc, 1].mean()))
    return upper.astype(np.intp), lower.astype(np.intp)


def lip_sides(
    vertices: NDArray[np.floating],
    triangles: NDArray[np.integer],
    upper: NDArray[np.integer],
    lower: NDArray[np.integer],
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(S,) and (S,) the skin of the `upper` and of the `lower` lip, of each of which the rim's vertices are given.

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
