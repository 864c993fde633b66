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


def unique_edges(pairs: NDArray[np.integer]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The edges (E, 2) among `pairs` (N, 2) of vertices, each once with the lower vertex first, in ascending order, and which
    of them each pair is, (N,)."""
    low, high = pairs.min(1).astype(np.int64), pairs.max(1).astype(np.int64)
    order, starts = _runs(low * (int(high.max(initial=0)) + 1) + high)
    first = order[starts]
    which = np.empty(len(pairs), np.intp)
    which[order] = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(order)))
    return np.stack([low[first], high[first]], 1).astype(np.intp), which


def edges(triangles: NDArray[np.integer]) -> NDArray[np.int32]:
    """(E, 2) int32: each edge of `triangles` (T, 3) once, the lower vertex first, in ascending order."""
    return unique_edges(np.stack([triangles.ravel(), np.roll(triangles, -1, 1).ravel()], 1))[0].astype(np.int32)


def open_edges(triangles: NDArray[np.integer]) -> NDArray[np.intp]:
    """(E, 2) edges that one of `triangles` (T, 3) alone has, in the direction in which that turns."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.intp)
    which = unique_edges(sides)[1]
    return sides[np.bincount(which)[which] == 1]


def edge_table(triangles: NDArray[np.int32], point: NDArray[np.int32]) -> NDArray[np.int32]:
    """(E, 4) int32: the edges of the surface that `triangles` (T, 3) make: two vertices, and the triangles on both sides.

    Vertices with one `point` (V,) are one. A border, or an edge at which several surfaces meet, is there once for each
    triangle, with -1 in place of the other.
    """
    count = int(point.max()) + 1
    start, end = triangles.ravel(), np.roll(triangles, -1, 1).ravel()
    low, high = np.minimum(point[start], point[end]), np.maximum(point[start], point[end])
    order, starts = _runs(low.astype(np.int64) * count + high)
    times = np.diff(starts, append=len(order))
    paired = starts[times == 2]
    single = np.flatnonzero(np.repeat(times != 2, times))
    here = order[np.concatenate([paired, single])]
    there = np.concatenate([order[paired + 1] // 3, np.full(len(single), -1)])
    return np.stack([start[here], end[here], here // 3, there], 1).astype(np.int32)


def _runs(key: NDArray[np.int64]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """In which order keys (N,) ascend, equal ones as they come, and where in it each value begins. (`np.unique` tells the same
    by a hash of every key, in several times as long.)"""
    order = np.argsort(key, kind="stable")
    ascending = key[order]
    return order, np.flatnonzero(np.concatenate([np.ones(min(len(key), 1), bool), ascending[1:] != ascending[:-1]]))
