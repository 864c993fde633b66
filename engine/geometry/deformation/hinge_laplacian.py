"""How a surface bends at its edges: a Laplacian for each edge with a triangle on both sides, and how edges turn.

Source: M. Bergou, M. Wardetzky, D. Harmon, D. Zorin, E. Grinspun, A quadratic bending model for inextensible surfaces,
SGP 2006 (the operator of a hinge, from the cotangents of its four outer angles); with the rotations of J. Achenbach,
E. Zell, M. Botsch, Accurate face reconstruction through anisotropic fitting and eye correction, VMV 2015.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import edge_table, edges
from engine.geometry.mesh.surface import triangle_areas, vertex_normals
from engine.geometry.nearest_rotations import nearest_rotations

MAX_COTANGENT = 4.0
"""Slivers have boundless cotangents: a hinge of one would outweigh its neighbours."""


class HingeLaplacian:
    """The hinges of a surface at rest.

    `hinges` (H, 4) int: both ends of an edge, then the vertices opposite in the triangles on its two sides.
    `areas` (H,): a third of the two triangles', in the square of the vertices' unit.
    `operator` (H, V) sparse: times vertices, the Laplacian at each edge, one by their unit; zero where the hinge is flat.
    """

    def __init__(self, rest: NDArray[np.floating], triangles: NDArray[np.integer]):
        """Of `rest` (V, 3) and `triangles` (T, 3), whose edges have two triangles at most, turning alike."""
        self.rest = np.asarray(rest, np.float64)
        self.triangles = np.ascontiguousarray(triangles, np.int32)
        count = len(self.rest)
        table = edge_table(self.triangles, np.arange(count, dtype=np.int32))
        table = table[table[:, 3] >= 0]
        self.hinges = np.column_stack([table[:, :2], *(_opposite(self.triangles, table, side) for side in (2, 3))])
        corners = self.rest[self.hinges]
        both = triangle_areas(self.rest, self.triangles)[table[:, 2:]].sum(1)
        self.areas = np.maximum(both / 3, np.finfo(np.float64).tiny)
        rows = np.arange(len(self.hinges)).repeat(4)
        values = _hinge_weights(corners) / self.areas[:, None]
        self.operator = sp.csr_array((values.ravel(), (rows, self.hinges.ravel())), (len(self.hinges), count))
        self._at_rest = np.asarray(self.operator @ self.rest)
        self._edges = edges(self.triangles)
        spokes = self.rest[self._edges[:, 0]] - self.rest[self._edges[:, 1]]
        lengths = np.maximum(np.linalg.norm(spokes, axis=1), np.finfo(np.float64).tiny)
        self._spokes = spokes / lengths[:, None]
        ends = (self._edges.ravel(), np.arange(len(self._edges)).repeat(2))
        self._around = sp.csr_array((np.ones(2 * len(self._edges)), ends), (count, len(self._edges)))
        self._normals = vertex_normals(self.rest, self.triangles).astype(np.float64)
        self._normal_weights = (self._around @ lengths) / 2

    def rotations(self, vertices: NDArray[np.floating]) -> NDArray[np.float64]:
        """(H, 3, 3) how each hinge has turned from rest, where the surface is at `vertices` (V, 3): by the edges around both
        its ends and their normals."""
        moved = np.asarray(vertices, np.float64)
        now = moved[self._edges[:, 0]] - moved[self._edges[:, 1]]
        spread = self._around @ (self._spokes[:, :, None] * now[:, None, :]).reshape(-1, 9)
        normals = vertex_normals(moved, self.triangles).astype(np.float64)
        spread = spread.reshape(-1, 3, 3)
        spread += self._normal_weights[:, None, None] * self._normals[:, :, None] * normals[:, None, :]
        return nearest_rotations(spread[self.hinges[:, 0]] + spread[self.hinges[:, 1]])

    def turned(self, rotations: NDArray[np.floating]) -> NDArray[np.float64]:
        """(H, 3) the Laplacians at rest, turned by `rotations` (H, 3, 3)."""
        return np.einsum("hij,hj->hi", rotations, self._at_rest)


def _opposite(triangles: NDArray[np.int32], table: NDArray[np.int32], side: int) -> NDArray[np.int32]:
    """(H,) the vertex of the triangle on one side of each edge that is not of the edge."""
    corners = triangles[table[:, side]]
    return np.asarray(corners.sum(1) - table[:, :2].sum(1), np.int32)


def _hinge_weights(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(H, 4) the sums of cotangents by which the vertices (H, 4, 3) of hinges count."""
    start, end, here, there = corners.transpose(1, 0, 2)
    edge = end - start
    at_start = [_cotangents(edge, tip - start) for tip in (here, there)]
    at_end = [_cotangents(-edge, tip - end) for tip in (here, there)]
    return np.stack([sum(at_end), sum(at_start), -at_start[0] - at_end[0], -at_start[1] - at_end[1]], 1)


def _cotangents(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    across = np.maximum(np.linalg.norm(np.cross(one, other), axis=1), np.finfo(np.float64).tiny)
    return np.asarray(np.clip((one * other).sum(1) / across, -MAX_COTANGENT, MAX_COTANGENT))
