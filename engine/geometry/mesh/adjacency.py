"""Which vertices, edges and triangles of a surface touch.

`point` (V,) says which vertices are one point of the surface (`engine.geometry.mesh.welding.weld`), for meshes that are cut along the
seams of a texture.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array


def neighbours(triangles: NDArray[np.integer], count: int) -> csr_array:
    """(V, V) float64, symmetric: 1 where two of `count` vertices share an edge of `triangles` (T, 3), else 0."""
    start, end = triangles.ravel(), np.roll(triangles, -1, 1).ravel()
    half = csr_array((np.ones(len(start)), (start, end)), shape=(count, count))
    return csr_array((half + half.T > 0).astype(np.float64))


def edges(triangles: NDArray[np.integer]) -> NDArray[np.int32]:
    """(E, 2) int32: each edge of `triangles` (T, 3) once, the lower vertex first, in ascending order."""
    pairs = np.stack([triangles.ravel(), np.roll(triangles, -1, 1).ravel()], 1)
    return np.unique(np.sort(pairs, 1), axis=0).astype(np.int32)


def edge_table(triangles: NDArray[np.int32], point: NDArray[np.int32]) -> NDArray[np.int32]:
    """(E, 4) int32: the edges of the surface that `triangles` (T, 3) make: two vertices, and the triangles on both sides.

    Vertices with one `point` (V,) are one. A border, or an edge at which several surfaces meet, is there once for each
    triangle, with -1 in place of the other.
    """
    count = int(point.max()) + 1
    start, end = triangles.ravel(), np.roll(triangles, -1, 1).ravel()
    low, high = np.minimum(point[start], point[end]), np.maximum(point[start], point[end])
    key = low.astype(np.int64) * count + high
    order = np.argsort(key, kind="stable")
    _, first, times = np.unique(key[order], return_index=True, return_counts=True)
    paired = first[times == 2]
    single = np.setdiff1d(np.arange(len(key)), np.concatenate([paired, paired + 1]))
    here = order[np.concatenate([paired, single])]
    there = np.concatenate([order[paired + 1] // 3, np.full(len(single), -1)])
    return np.stack([start[here], end[here], here // 3, there], 1).astype(np.int32)
