"""Meshes whose vertices are doubled along the seams of a texture, seen as the surfaces that they are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.surface import area_vectors, summed_at_corners
from engine.geometry.rigging.skinned_mesh import SkinnedMesh


def weld(mesh: SkinnedMesh) -> NDArray[np.int32]:
    """(V,) int32: to which point of the surface each vertex belongs, points numbered from 0.

    Vertices are one point where they lie at the same place and move alike (same bones, same weights): parts that
    merely touch at rest stay apart.
    """
    return same_rows(mesh.vertices, mesh.bones, mesh.weights)


def same_rows(*columns: NDArray[np.number]) -> NDArray[np.int32]:
    """(V,) int32: vertices that are alike to the bit in all `columns`, each (V, ...), have one number, counted from 0. What is no
    SkinnedMesh is welded by its places alone: `same_rows(vertices)`."""
    count = len(columns[0])
    positive = [np.ascontiguousarray(column + column.dtype.type(0)) for column in columns]  # no negative zeros
    key = np.concatenate([column.view(np.uint8).reshape(count, -1) for column in positive], 1)
    rows = np.ascontiguousarray(key).view(np.dtype((np.void, key.shape[1]))).ravel()
    return np.unique(rows, return_inverse=True)[1].astype(np.int32)


def is_closed(faces: NDArray[np.integer]) -> bool:
    """Whether triangles (T, 3) of points leave no border: every edge is met once in each direction."""
    count = int(faces.max()) + 1 if len(faces) else 0
    start, end = faces.ravel().astype(np.int64), np.roll(faces, -1, 1).ravel().astype(np.int64)
    there, back = np.sort(start * count + end), np.sort(end * count + start)
    return bool((there == back).all() and (np.diff(there) > 0).all())


def seamless_normals(mesh: SkinnedMesh, points: NDArray[np.int32] | None = None) -> NDArray[np.float32]:
    """(V, 3) float32 unit normals at rest, the same on both sides of a seam of the texture.

    `points`: as `weld` has them, by default of this mesh. A vertex without area about it gets (0, 1, 0), since file formats ask for unit normals.
    """
    point = weld(mesh) if points is None else points
    areas = area_vectors(mesh.vertices.astype(np.float64), mesh.triangles)
    sums = summed_at_corners(areas, point[mesh.triangles], int(point.max()) + 1)
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    normals = np.where(lengths > 1e-20, sums / np.maximum(lengths, 1e-20), [0.0, 1.0, 0.0])
    return normals[point].astype(np.float32)
