"""Triangles over points of the plane that keep to given lines: where a picture has an edge along which its two sides move apart.

Delaunay's triangles know distances alone: where points stand closer across such an edge than along it, triangles span it, and what moves tears it into teeth.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from engine.imaging.warping.delaunay import delaunay

MAX_FLIPS_PER_CROSSING = 16
"""How often an edge that crosses a line is turned, in the mean of all, before the line is given up."""


def constrained_delaunay(points: NDArray[np.floating], lines: NDArray[np.integer]) -> NDArray[np.int32]:
    """(T, 3) Delaunay's triangles over points (V, 2), as `delaunay` orders them, in which each of `lines` (L, 2), two vertices, is an edge. One that crosses an
    earlier one, runs through a point or ends at one that has no triangles is left out.

    Source: S. W. Sloan, A fast algorithm for generating constrained Delaunay triangulations, 1993, section 3.
    """
    triangles = delaunay(points)
    flat = np.asarray(points, float)
    ends = flat[np.asarray(lines, int)].reshape(-1, 2)
    if not len(ends):
        return triangles
    corners = flat[triangles]
    near = ((corners.min(axis=1) <= ends.max(axis=0)) & (corners.max(axis=1) >= ends.min(axis=0))).all(axis=1)
    mesh = _Triangles(flat, triangles[near])
    for a, b in np.asarray(lines, int).tolist():
        mesh.lead_through(a, b)
    return np.concatenate([triangles[~near], np.array(mesh.triangles, np.int32).reshape(-1, 3)]).astype(np.int32)


class _Triangles:
    """Triangles whose edges can be turned."""

    def __init__(self, points: NDArray[np.float64], triangles: NDArray[np.int32]):
        self._at = points
        self.triangles: list[list[int]] = triangles.tolist()
        self._beside: dict[tuple[int, int], int] = {}
        """The triangle to the same side of each directed edge."""
        self._kept: set[tuple[int, int]] = set()
        for number in range(len(self.triangles)):
            self._enter(number)

    def lead_through(self, a: int, b: int) -> None:
        """Make two vertices the ends of an edge, which stays one; or leave all as it is."""
        if (a, b) in self._beside or (b, a) in self._beside:
            self._kept.add(_both(a, b))
            return
        waiting = deque(self._crossing(a, b))
        if not waiting or any(one in self._kept for one in waiting):
            return
        before = [list(one) for one in self.triangles]
        for _ in range(MAX_FLIPS_PER_CROSSING * len(waiting)):
            p, q = waiting.popleft()
            r, s = self._opposite(p, q), self._opposite(q, p)
            if not self._cross(p, q, r, s):
                waiting.append((p, q))
                continue
            self._turn(p, q, r, s)
            if self._cross(a, b, r, s):
                waiting.append((r, s))
            if not waiting:
                break
        if (a, b) in self._beside or (b, a) in self._beside:
            self._kept.add(_both(a, b))
            return
        self.triangles, self._beside = before, {}
        for number in range(len(self.triangles)):
            self._enter(number)

    def _crossing(self, a: int, b: int) -> list[tuple[int, int]]:
        """The edges between two triangles that the line from a to b crosses, each once."""
        edge = np.array(self.triangles)[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        edge = edge[edge[:, 0] < edge[:, 1]]
        places, start, way = self._at[edge], self._at[a], self._at[b] - self._at[a]
        side = way[0] * (places[..., 1] - start[1]) - way[1] * (places[..., 0] - start[0])
        found = edge[side[:, 0] * side[:, 1] < 0].tolist()
        return [(p, q) for p, q in found if (q, p) in self._beside and self._cross(a, b, p, q)]

    def _turn(self, p: int, q: int, r: int, s: int) -> None:
        """Put the edge from r to s in the place of that from p to q, which is between them."""
        first, second = self._beside.pop((p, q)), self._beside.pop((q, p))
        self.triangles[first], self.triangles[second] = [r, s, q], [s, r, p]
        self._enter(first)
        self._enter(second)

    def _enter(self, number: int) -> None:
        a, b, c = self.triangles[number]
        self._beside.update({(a, b): number, (b, c): number, (c, a): number})

    def _opposite(self, p: int, q: int) -> int:
        """The third corner of the triangle beside the edge from p to q."""
        return next(v for v in self.triangles[self._beside[p, q]] if v not in (p, q))

    def _cross(self, a: int, b: int, p: int, q: int) -> bool:
        """Whether the line from a to b and that from p to q cross between their ends."""
        return (
            len({a, b, p, q}) == 4
            and self._side(a, b, p) * self._side(a, b, q) < 0
            and self._side(p, q, a) * self._side(p, q, b) < 0
        )

    def _side(self, a: int, b: int, c: int) -> float:
        (ax, ay), (bx, by), (cx, cy) = self._at[a], self._at[b], self._at[c]
        return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def _both(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)
