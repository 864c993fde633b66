"""The mesh of a piece: connected, fair, of few triangles, and without what the skin hides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from engine.avatar.attachments.body_surface import BodySurface
from engine.geometry.mesh.adjacency import neighbours
from engine.geometry.mesh.fairing import fair
from engine.geometry.mesh.surface import triangle_areas
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.simplification.decimation import decimate

FAIRING_ROUNDS = 50
"""Rounds of fairing."""
MIN_PIECE_SQUARE_METRES = 0.015
"""Square metres of a piece's surface, both its sides: less is no hat and no tail."""
HIDDEN_DEPTH_METRES = 0.003
"""Metres within the skin from which on nothing is seen of a piece."""
HIDDEN_TRIANGLE_WEIGHT = 0.02
"""What counts, against the rest, of a piece that is hidden within the skin, when triangles are taken."""

Mesh = tuple[NDArray[np.float64], NDArray[np.int32]]
"""Vertices (V, 3) and triangles (T, 3)."""


def piece_meshes(vertices: NDArray[np.floating], triangles: NDArray[np.integer]) -> list[Mesh]:
    """Those parts of a solid's surface that are not too small to be worn, each closed and fair, the largest first: front and back of a
    jacket's skirt, between which nothing is."""
    parts = _parts(np.asarray(vertices, np.float64), np.asarray(triangles, np.int32))
    large = [mesh for mesh in parts if triangle_areas(*mesh).sum() >= MIN_PIECE_SQUARE_METRES]
    return [(fair(*mesh, FAIRING_ROUNDS), mesh[1]) for mesh in large]


def seen_area(mesh: Mesh, body: BodySurface) -> float:
    """Square metres of what the skin does not hide of a piece."""
    return float(triangle_areas(*mesh)[_seen(*mesh, body)].sum())


def simplified(mesh: Mesh, body: BodySurface, triangles: int) -> Mesh:
    """What the skin does not hide of a closed piece, with so many triangles at most."""
    vertices, corners = mesh
    count = len(vertices)
    one = Skeleton(("root",), np.array([-1], np.int32), np.zeros((1, 3), np.float32))
    whole = SkinnedMesh(
        skeleton=one,
        vertices=vertices.astype(np.float32),
        triangles=corners,
        uv=np.zeros((count, 2), np.float32),
        bones=np.zeros((count, 4), np.uint8),
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)),
        texture=np.zeros((1, 1, 3), np.uint8),
    )
    hidden = body.distances(vertices) < -HIDDEN_DEPTH_METRES
    fewer = decimate(whole, triangles, np.where(hidden, HIDDEN_TRIANGLE_WEIGHT, 1.0)).mesh
    return seen_part((fewer.vertices.astype(np.float64), fewer.triangles), body)


def seen_part(mesh: Mesh, body: BodySurface) -> Mesh:
    """What the skin does not hide of a closed piece, its triangles as they are."""
    found = _parts(mesh[0], mesh[1][_seen(*mesh, body)])
    assert found, "a piece that silhouettes confirm is seen"
    return found[0]


def _seen(vertices: NDArray[np.float64], triangles: NDArray[np.int32], body: BodySurface) -> NDArray[np.bool_]:
    """(T,) which triangles have their middle outside of the skin, or nearly so."""
    return body.distances(vertices[triangles].mean(1)) > -HIDDEN_DEPTH_METRES


def _parts(vertices: NDArray[np.float64], triangles: NDArray[np.int32]) -> list[Mesh]:
    """The connected parts of a mesh, that of the largest surface first."""
    if not len(triangles):
        return []
    part = connected_components(neighbours(triangles, len(vertices)), directed=False)[1][triangles[:, 0]]
    area = np.bincount(part, triangle_areas(vertices, triangles))
    found = []
    for number in np.argsort(-area, kind="stable")[: np.count_nonzero(area)]:
        used, index = np.unique(triangles[part == number], return_inverse=True)
        found.append((vertices[used], index.reshape(-1, 3).astype(np.int32)))
    return found
