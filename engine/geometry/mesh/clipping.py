"""Surfaces cut along a level of what is known at their vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import unique_edges

MIN_CUT_SHARE = 0.02
"""Share of an edge from either end within which no edge is cut: slivers have no normal."""


@dataclass(frozen=True)
class Clipping:
    """What is left of a surface above a level.

    triangles : (M, 3) int32, of the vertices as they were and, numbered after them, of those at which edges are cut.
    edges : (E, 2) int, the vertices at the ends of each cut edge, the lower number first.
    shares : (E,) float64, how far from the first to the second it is cut.
    """

    triangles: NDArray[np.int32]
    edges: NDArray[np.intp]
    shares: NDArray[np.float64]

    def extended(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """Values (V, ...) of the vertices with those of the cuts (V + E, ...), linear along each edge."""
        share = self.shares.reshape(-1, *(1,) * (values.ndim - 1))
        first, second = values[self.edges[:, 0]], values[self.edges[:, 1]]
        return np.concatenate([values.astype(np.float64), first + share * (second - first)])


def clip(triangles: NDArray[np.integer], field: NDArray[np.floating]) -> Clipping:
    """The part of a surface of `triangles` (T, 3) where a `field` (V,), linear on each, is above zero."""
    inside = field > 0
    count = inside[triangles].sum(1)
    whole = triangles[count == 3]
    alone = _turned(triangles[count == 1], inside)  # the first corner is within
    without = _turned(triangles[count == 2], ~inside)  # the first corner is beyond
    pairs = np.concatenate([alone[:, [0, 1]], alone[:, [0, 2]], without[:, [0, 1]], without[:, [0, 2]]])
    ends, number = unique_edges(pairs)
    low, high = field[ends[:, 0]].astype(np.float64), field[ends[:, 1]].astype(np.float64)
    shares = np.clip(low / np.where(low == high, 1, low - high), MIN_CUT_SHARE, 1 - MIN_CUT_SHARE)
    parts = [len(alone), 2 * len(alone), 2 * len(alone) + len(without)]
    one, two, near, far = np.split(number + len(field), parts)
    made = [
        whole,
        np.stack([alone[:, 0], one, two], 1),
        np.stack([near, without[:, 1], without[:, 2]], 1),
        np.stack([near, without[:, 2], far], 1),
    ]
    return Clipping(np.concatenate(made).astype(np.int32), ends, shares)


def _turned(triangles: NDArray[np.integer], which: NDArray[np.bool_]) -> NDArray[np.integer]:
    """Triangles (T, 3) turned so that the one corner that is `which` (V,) comes first."""
    first = which[triangles].argmax(1) if len(triangles) else np.zeros(0, int)
    return triangles[np.arange(len(triangles))[:, None], (first[:, None] + np.arange(3)) % 3]


def walled(triangles: NDArray[np.int32], point: NDArray[np.int32], beneath: int) -> NDArray[np.int32]:
    """The closed surface (M, 3) of `triangles` (T, 3) and, turned over, of the same ones `beneath` vertices further on, with a wall along
    their border, whose lower vertices are as many again further on: it may have colours of its own. Vertices of one `point` (V,) are
    one, so that no wall stands along a texture's seam."""
    start, end = triangles.ravel(), np.roll(triangles, -1, 1).ravel()
    count = int(point.max()) + 1
    key, back = (point[a].astype(np.int64) * count + point[b] for a, b in ((start, end), (end, start)))
    border = ~np.isin(key, back)
    a, b = start[border], end[border]
    foot = 2 * beneath
    wall = np.concatenate([np.stack([b, a, a + foot], 1), np.stack([b, a + foot, b + foot], 1)])
    return np.concatenate([triangles, triangles[:, ::-1] + beneath, wall]).astype(np.int32)
