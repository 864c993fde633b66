"""The points of a surface that lie nearest to given points.

Source of the closest point of a triangle: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from engine.compiled import njit
from engine.geometry.mesh.surface import vertex_normals

NEAREST_VERTICES = 3
"""Vertices whose triangles are looked at for each point."""
SINGLE_THREAD_POINTS = 2048
"""How many points are looked for without threads. Starting threads costs more, and a process that has started any must
not be forked."""


@dataclass(frozen=True)
class ClosestPoints:
    """Of each of N points, the nearest of the surface.

    distance : (N,) in the vertices' unit.
    triangle : (N,) int, the triangle in which it lies.
    barycentrics : (N, 3) where in it, summing to one.
    """

    distance: NDArray[np.float64]
    triangle: NDArray[np.intp]
    barycentrics: NDArray[np.float64]

    def __getitem__(self, which: NDArray[np.bool_] | NDArray[np.integer]) -> ClosestPoints:
        """Those of some of the points."""
        return ClosestPoints(self.distance[which], self.triangle[which], self.barycentrics[which])

    def interpolated(self, values: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
        """(N, C) `values` (V, C) of the surface's vertices where its nearest points are."""
        return np.einsum("nk,nkc->nc", self.barycentrics, np.asarray(values, np.float64)[triangles[self.triangle]])

    def beneath(
        self, depth: NDArray[np.floating], vertices: NDArray[np.floating], triangles: NDArray[np.integer]
    ) -> NDArray[np.float64]:
        """(N, 3) points `depth` (N,) below the nearest ones, along the surface's smoothed normals."""
        normals = self.interpolated(vertex_normals(vertices, triangles), triangles)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        return self.interpolated(vertices, triangles) - depth[:, None] * normals


def closest_points(
    points: NDArray[np.floating], vertices: NDArray[np.floating], triangles: NDArray[np.integer]
) -> ClosestPoints:
    """The nearest points of the surface `triangles` (T, 3) over `vertices` (V, 3) to `points` (N, 3), all in one unit.

    Triangles around the few nearest vertices are looked at, so that far from a surface of triangles of very unlike size a
    point a little further away may be found instead. Raises ValueError where the surface has no triangle.
    """
    if not len(triangles):
        raise ValueError("a surface without triangles has no closest points")
    corners = np.ascontiguousarray(triangles, np.intp)
    places = np.ascontiguousarray(vertices, np.float64)
    asked = np.ascontiguousarray(points, np.float64)
    used, at = np.unique(corners, return_inverse=True)
    order = np.argsort(at.ravel(), kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(at.ravel(), minlength=len(used)))])
    count = min(NEAREST_VERTICES, len(used))
    near = cKDTree(places[used]).query(asked, k=count)[1].reshape(len(asked), count)
    found = ClosestPoints(np.empty(len(asked)), np.zeros(len(asked), np.intp), np.zeros((len(asked), 3)))
    search = _find_few if len(asked) <= SINGLE_THREAD_POINTS else _find_many
    search(asked, places, corners, near, starts, order // 3, found.distance, found.triangle, found.barycentrics)
    return found


@njit(parallel=True, nogil=True, boundscheck=False, error_model="numpy")
def _find_many(points, vertices, triangles, near, starts, touching, distance, triangle, barycentrics):  # type: ignore[no-untyped-def]
    for k in prange(len(points)):
        i = np.int64(k)  # not the unsigned one of `prange`, for which all that is called would be compiled once more
        distance[i], triangle[i] = _nearest(i, points, vertices, triangles, near, starts, touching, barycentrics)


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _find_few(points, vertices, triangles, near, starts, touching, distance, triangle, barycentrics):  # type: ignore[no-untyped-def]
    for i in range(len(points)):
        distance[i], triangle[i] = _nearest(i, points, vertices, triangles, near, starts, touching, barycentrics)


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _nearest(i, points, vertices, triangles, near, starts, touching, barycentrics):  # type: ignore[no-untyped-def]
    """The distance of one point, and of which triangle; its barycentrics are written into theirs."""
    best, triangle = np.inf, 0
    p = _place(points, i)
    for k in range(near.shape[1]):
        for j in range(starts[near[i, k]], starts[near[i, k] + 1]):
            t = touching[j]
            a, b, c = (
                _place(vertices, triangles[t, 0]),
                _place(vertices, triangles[t, 1]),
                _place(vertices, triangles[t, 2]),
            )
            u, v, w = _within_triangle(p, a, b, c)
            squared = 0.0
            for axis in range(3):
                off = p[axis] - u * a[axis] - v * b[axis] - w * c[axis]
                squared += off * off
            if squared < best:
                best, triangle = squared, t
                barycentrics[i, 0], barycentrics[i, 1], barycentrics[i, 2] = u, v, w
    return np.sqrt(best), triangle


@njit(nogil=True, error_model="numpy")
def _within_triangle(p, a, b, c):  # type: ignore[no-untyped-def]
    """Barycentrics of the point of a triangle that is nearest to `p`: by the region in which `p` lies."""
    ab, ac, ap, bp, cp = _minus(b, a), _minus(c, a), _minus(p, a), _minus(p, b), _minus(p, c)
    along_b, along_c = _dot(ab, ap), _dot(ac, ap)
    if along_b <= 0 and along_c <= 0:
        return 1.0, 0.0, 0.0
    beyond_b, beside_b = _dot(ab, bp), _dot(ac, bp)
    if beyond_b >= 0 and beside_b <= beyond_b:
        return 0.0, 1.0, 0.0
    off_ab = along_b * beside_b - beyond_b * along_c
    if off_ab <= 0 and along_b >= 0 and beyond_b <= 0:
        v = along_b / (along_b - beyond_b)
        return 1 - v, v, 0.0
    beside_c, beyond_c = _dot(ab, cp), _dot(ac, cp)
    if beyond_c >= 0 and beside_c <= beyond_c:
        return 0.0, 0.0, 1.0
    off_ac = beside_c * along_c - along_b * beyond_c
    if off_ac <= 0 and along_c >= 0 and beyond_c <= 0:
        w = along_c / (along_c - beyond_c)
        return 1 - w, 0.0, w
    off_bc = beyond_b * beyond_c - beside_c * beside_b
    if off_bc <= 0 and beside_b >= beyond_b and beside_c >= beyond_c:
        w = (beside_b - beyond_b) / ((beside_b - beyond_b) + (beside_c - beyond_c))
        return 0.0, 1 - w, w
    total = off_ab + off_ac + off_bc
    return off_bc / total, off_ac / total, off_ab / total


@njit(nogil=True)
def _place(places, i):  # type: ignore[no-untyped-def]
    return places[i, 0], places[i, 1], places[i, 2]


@njit(nogil=True)
def _minus(a, b):  # type: ignore[no-untyped-def]
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(nogil=True)
def _dot(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
