"""The inner loops of `engine.geometry.simplification.decimation`: which collapses are allowed, and the surgery of one.

A *point* is a place of the surface, a *vertex* one of its copies (one for each side of a texture's seam). The corners
that meet at a point hang on a linked list; a collapse joins two lists.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.geometry.simplification.heap import sift_down, sift_up
from engine.geometry.simplification.one_ring import corner_successors, one_ring
from engine.geometry.simplification.quadrics import cheapest_collapses, collapse_cost, surface_quadrics, texture_seams

MAX_COLLAPSED_VALENCE = 64
"""The most neighbours of a point that is collapsed; one that has more stays."""

PRICE_TOLERANCE_SHARE = 0.05
"""A collapse goes ahead although it has become dearer by this share since it was priced."""


@njit(nogil=True, error_model="numpy")
def _best(
    u: int,
    places: np.ndarray,
    faces: np.ndarray,
    corners: np.ndarray,
    uv: np.ndarray,
    alive: np.ndarray,
    head: np.ndarray,
    following: np.ndarray,
    quadrics: np.ndarray,
    bones: np.ndarray,
    weights: np.ndarray,
    factors: np.ndarray,
    bending: float,
    around: np.ndarray,
    around_other: np.ndarray,
    costs: np.ndarray,
    seen: np.ndarray,
    wedges: np.ndarray,
) -> tuple:
    """The cheapest collapse of `u`: its cost and where to; (inf, -1) if none is allowed."""
    count = one_ring(u, faces, alive, head, following, around, seen)
    if count <= 0 or factors[u] == np.inf:
        return np.inf, -1
    border = 0
    for i in range(count):
        if around[i, 1] == 1:
            border += 1
        elif around[i, 1] > 2:
            return np.inf, -1  # sheets that meet in an edge
    if border not in (0, 2):
        return np.inf, -1
    for i in range(count):
        v = np.int64(around[i, 0])  # of one type wherever points are named: all that is called is compiled once
        cost = collapse_cost(u, v, places, quadrics, bones, weights, bending)
        along = border == 0 or around[i, 1] == 1  # a border is left along itself alone
        costs[i] = cost * factors[u] if along else np.inf
    while True:  # the cheapest first
        chosen = 0
        for i in range(1, count):
            if costs[i] < costs[chosen]:
                chosen = i
        price = costs[chosen]
        if price == np.inf:
            return np.inf, -1
        costs[chosen] = np.inf
        v = np.int64(around[chosen, 0])
        others = one_ring(v, faces, alive, head, following, around_other, seen)
        if others < 0 or count + others > MAX_COLLAPSED_VALENCE:
            continue
        # link condition: the only points next to both are those of the triangles on the edge
        common = 0
        for i in range(count):
            seen[around[i, 0]] = 1
        for i in range(others):
            if seen[around_other[i, 0]] == 1:
                common += 1
        for i in range(count):
            seen[around[i, 0]] = -1
        if common != around[chosen, 1] or (count == 3 and others == 3 and border == 0):
            continue
        if corner_successors(u, v, places, faces, corners, uv, alive, head, following, wedges) > 0:
            return price, v


def collapse_edges(
    places: NDArray[np.float64],
    point: NDArray[np.int32],
    corners: NDArray[np.int32],
    uv: NDArray[np.float64],
    bones: NDArray[np.uint8],
    weights: NDArray[np.float64],
    factors: NDArray[np.float64],
    target: int,
    holds: NDArray[np.float64],
) -> NDArray[np.int32]:
    """Collapse until `target` triangles are left: (T', 3) int32 vertices, in the order in which they came.

    `places` (P, 3), `bones` and `weights` (P, 4) and `factors` (P,) belong to points; `point` (V,) and `uv` (V, 2) to
    vertices; `corners` (T, 3) are vertices. `holds`: the weights of borders, of seams and of bending.
    """
    faces = np.ascontiguousarray(point[corners])
    following = np.roll(faces, -1, 1)
    keys = np.minimum(faces, following).astype(np.int64) * len(places) + np.maximum(faces, following)
    named, edges, shared = np.unique(keys.ravel(), return_inverse=True, return_counts=True)
    edges = edges.reshape(-1, 3)
    seams = texture_seams(faces, corners, edges, len(shared))
    hold = np.where(shared == 1, holds[0], np.where(seams, holds[1], 0.0))
    quadrics = surface_quadrics(places, faces, corners, edges, hold)
    ends = np.stack(np.divmod(named, len(places)), 1)
    first = cheapest_collapses(ends, places, quadrics, bones, weights, factors, holds[2])
    order = np.argsort(first, kind="stable")
    corners = corners.copy()
    alive = _collapse(places, faces, corners, uv, bones, weights, factors, quadrics, first, order, target, holds[2])
    return corners[alive]


@njit(nogil=True, error_model="numpy")
def _collapse(
    places: np.ndarray,
    faces: np.ndarray,
    corners: np.ndarray,
    uv: np.ndarray,
    bones: np.ndarray,
    weights: np.ndarray,
    factors: np.ndarray,
    quadrics: np.ndarray,
    first: np.ndarray,
    order: np.ndarray,
    target: int,
    bending: float,
) -> np.ndarray:
    points, left = len(places), len(faces)
    alive, head, following = np.empty(left, np.bool_), np.empty(points, np.int32), np.empty(3 * left, np.int32)
    alive[:], head[:], following[:] = True, -1, -1
    for corner in range(3 * left):
        p = faces[corner // 3, corner % 3]
        following[corner] = head[p]
        head[p] = corner
    around = np.empty((MAX_COLLAPSED_VALENCE, 2), np.int32)
    around_other = np.empty((MAX_COLLAPSED_VALENCE, 2), np.int32)
    costs = np.empty(MAX_COLLAPSED_VALENCE)
    to_mend = np.empty(MAX_COLLAPSED_VALENCE, np.int32)
    seen = np.empty(points, np.int32)
    seen[:] = -1
    wedges = np.empty((8, 2), np.int32)
    waiting = np.zeros(points, np.bool_)
    heap_keys, heap_items, size = np.empty(points), np.empty(points, np.int32), 0
    for u in order:
        if first[u] < np.inf:
            heap_keys[size], heap_items[size] = first[u], u  # in order, so a heap already
            size += 1
            waiting[u] = True
    while left > target and size > 0:
        key, u = heap_keys[0], np.int64(heap_items[0])
        size -= 1
        heap_keys[0], heap_items[0] = heap_keys[size], heap_items[size]
        sift_down(heap_keys, heap_items, size)
        waiting[u] = False
        if head[u] < 0:
            continue
        price, v = _best(
            u, places, faces, corners, uv, alive, head, following, quadrics, bones, weights, factors, bending,
            around, around_other, costs, seen, wedges,
        )  # fmt: skip
        if v < 0:
            continue
        if price > key * (1 + PRICE_TOLERANCE_SHARE):  # its surroundings have changed: it has to queue again
            heap_keys[size], heap_items[size] = price, u
            sift_up(heap_keys, heap_items, size)
            size += 1
            waiting[u] = True
            continue
        copies = corner_successors(u, v, places, faces, corners, uv, alive, head, following, wedges)
        corner, last = head[u], head[u]
        while corner >= 0:
            t = corner // 3
            if alive[t]:
                k = corner - 3 * t
                if faces[t, 0] == v or faces[t, 1] == v or faces[t, 2] == v:
                    alive[t] = False
                    left -= 1
                else:
                    faces[t, k] = v
                    for i in range(copies):
                        if wedges[i, 0] == corners[t, k]:
                            corners[t, k] = wedges[i, 1]
                            break
            last = corner
            corner = following[corner]
        following[last] = head[v]
        head[v] = head[u]
        head[u] = -1
        for k in range(10):
            quadrics[v, k] += quadrics[u, k]
        # prices only rise, so those who wait may wait; the others might be allowed to go now
        count = one_ring(v, faces, alive, head, following, around, seen)
        for i in range(count):
            to_mend[i] = around[i, 0]
        for i in range(-1, count):
            p = v if i < 0 else np.int64(to_mend[i])
            if waiting[p]:
                continue
            price, where = _best(
                p, places, faces, corners, uv, alive, head, following, quadrics, bones, weights, factors, bending,
                around, around_other, costs, seen, wedges,
            )  # fmt: skip
            if where >= 0:
                heap_keys[size], heap_items[size] = price, p
                sift_up(heap_keys, heap_items, size)
                size += 1
                waiting[p] = True
    return alive
