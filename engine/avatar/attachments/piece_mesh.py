"""The mesh of a piece: connected, fair, of few triangles, and without what the skin hides."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.fairing import fair
from engine.geometry.simplification.decimation import decimate
from engine.geometry.skeleton import Skeleton
from engine.geometry.skinned_mesh import SkinnedMesh
from engine.geometry.surface import triangle_areas

FAIRINGS = 50
"""Rounds of fairing."""
LEAST_AREA = 0.015
"""Square metres of a piece's surface, both its sides: less is no hat and no tail."""
HIDDEN_DEPTH = 0.003
"""Metres within the skin from which on nothing is seen of a piece."""

Mesh = tuple[NDArray[np.float64], NDArray[np.int32]]
"""Vertices (V, 3) and triangles (T, 3)."""


def piece_mesh(vertices: NDArray[np.floating], triangles: NDArray[np.integer], body: BodySurface) -> Mesh | None:
    """What is seen of the largest part of a solid's surface, fair; None where that is too small to be worn."""
    mesh = _largest(np.asarray(vertices, np.float64), np.asarray(triangles, np.int32))
    if mesh is None or triangle_areas(*mesh).sum() < LEAST_AREA:
        return None
    moved = fair(*mesh, FAIRINGS)
    seen = (body.distances(moved) > -HIDDEN_DEPTH)[mesh[1]].any(1)
    return _largest(moved, mesh[1][seen])


def simplified(mesh: Mesh, triangles: int) -> Mesh:
    """A mesh of so many triangles at most."""
    count = len(mesh[0])
    one = Skeleton(("root",), np.array([-1], np.int32), np.zeros((1, 3), np.float32))
    bones, weights = np.zeros((count, 4), np.uint8), np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1))
    whole = SkinnedMesh(
        one,
        mesh[0].astype(np.float32),
        mesh[1],
        np.zeros((count, 2), np.float32),
        bones,
        weights,
        np.zeros((1, 1, 3), np.uint8),
    )
    fewer = decimate(whole, triangles).mesh
    return fewer.vertices.astype(np.float64), fewer.triangles


def _largest(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> Mesh | None:
    """The connected part with the most area, without the other vertices."""
    if not len(triangles):
        return None
    start, end = triangles[:, [0, 1]].T
    start, end = np.concatenate([start, triangles[:, 1]]), np.concatenate([end, triangles[:, 2]])
    links = sp.csr_array((np.ones(len(start)), (start, end)), (len(vertices), len(vertices)))
    part = connected_components(links, directed=False)[1][triangles[:, 0]]
    kept = part == np.bincount(part, triangle_areas(vertices, triangles)).argmax()
    used, index = np.unique(triangles[kept], return_inverse=True)
    return vertices[used], index.reshape(-1, 3).astype(np.int32)
