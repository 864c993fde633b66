"""Surfaces made of triangles: their areas and normals, and the directions in which a chart runs on them.

`vertices` are (V, 3) in any unit of length, `triangles` (T, 3) indices, counter-clockwise seen from outside. Which vertices and
triangles touch is in `engine.geometry.mesh.adjacency`, which vertices are one point in `engine.geometry.mesh.welding`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


def triangulate(quads: NDArray[np.integer]) -> NDArray[np.int32]:
    """(F, 4) quads to (2F, 3) triangles: the first halves of all, then the second halves."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)


def area_vectors(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.floating]:
    """(T, 3) normals of the triangles, each as long as twice its area, in the vertices' precision."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.asarray(np.cross(b - a, c - a))


def summed_at_corners(values: NDArray[np.floating], triangles: NDArray[np.integer], count: int) -> NDArray[np.float64]:
    """(count, C) float64: of each vertex, the sum of the `values` (T, C) of its triangles. Of area vectors that is its normal,
    triangles weighted by their areas, in full precision."""
    corners = triangles.ravel()
    columns = [np.bincount(corners, column.repeat(3), minlength=count) for column in values.T]
    return np.stack(columns, 1).astype(np.float64)


def triangle_areas(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.floating]:
    """(T,) area of each triangle, in the vertices' precision and the square of their unit."""
    return np.asarray(np.linalg.norm(area_vectors(vertices, triangles), axis=1) / 2)


def vertex_areas(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.float64]:
    """(V,) float64: a third of the area of each vertex's triangles; together they are the surface's."""
    thirds = np.repeat(triangle_areas(vertices, triangles) / 3, 3)
    return np.asarray(np.bincount(triangles.ravel(), thirds, minlength=len(vertices)), np.float64)


def face_normals(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.floating]:
    """(T, 3) unit normals of the triangles, in the vertices' precision; zero for those without area."""
    doubled = area_vectors(vertices, triangles)
    length = np.linalg.norm(doubled, axis=1, keepdims=True)
    return np.asarray(doubled / np.where(length > 0, length, 1))


def vertex_normals(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> NDArray[np.float32]:
    """(V, 3) float32 unit normals, triangles weighted by their area; zero where a vertex has no triangle."""
    return _normals(np.ascontiguousarray(vertices, np.float32), np.ascontiguousarray(triangles, np.int32))


def chart_tangents(
    vertices: NDArray[np.floating], chart: NDArray[np.floating], triangles: NDArray[np.integer]
) -> NDArray[np.float32]:
    """How a surface point moves along its chart, (V, 6) float32: dP/du and dP/dv, means over the triangles.

    `chart` (V, 2) are the coordinates (u, v) of the vertices on the chart; triangles across its seam should be
    left out.
    """
    return _tangents(
        np.ascontiguousarray(vertices, np.float32),
        np.ascontiguousarray(chart, np.float32),
        np.ascontiguousarray(triangles, np.int32),
    )


@njit()
def _normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    out = np.zeros_like(vertices)
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
        vx, vy, vz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for k in (a, b, c):
            out[k, 0] += x
            out[k, 1] += y
            out[k, 2] += z
    for i in range(len(out)):
        length = np.sqrt(out[i, 0] ** 2 + out[i, 1] ** 2 + out[i, 2] ** 2)
        if length > 0:
            for k in range(3):
                out[i, k] /= length
    return out


@njit()
def _tangents(vertices: np.ndarray, chart: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    out = np.zeros((len(vertices), 6), np.float32)
    weights = np.zeros(len(vertices), np.float32)
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        u1, v1 = chart[b, 0] - chart[a, 0], chart[b, 1] - chart[a, 1]
        u2, v2 = chart[c, 0] - chart[a, 0], chart[c, 1] - chart[a, 1]
        area = u1 * v2 - u2 * v1
        if abs(area) < 1e-14:
            continue
        weight = abs(area)
        for k in range(3):
            p1, p2 = vertices[b, k] - vertices[a, k], vertices[c, k] - vertices[a, k]
            along_u = weight * (p1 * v2 - p2 * v1) / area
            along_v = weight * (p2 * u1 - p1 * u2) / area
            for i in (a, b, c):
                out[i, k] += along_u
                out[i, 3 + k] += along_v
        for i in (a, b, c):
            weights[i] += weight
    for i in range(len(out)):
        if weights[i] > 0:
            for k in range(6):
                out[i, k] /= weights[i]
    return out
