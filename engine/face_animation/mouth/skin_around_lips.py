"""What the skin around the lips does when they move: harmonic between them, the nose's base and the contour, so that nothing folds that was even."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.mesh.adjacency import edges
from engine.perception.face.face_tessellation import face_triangles
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import FACE_OVAL, MESH_SIZE, NOSE_BASE_VERTEX


def with_lips(vertices: NDArray[np.integer], moved: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, K) how far each vertex of a face goes where some `vertices` (L,) of its lips go as far as `moved` (L, K).
    It is between the least and the most of them, and nothing from the nose's base up and at the contour."""
    face = canonical_face().astype(float)
    pairs = edges(face_triangles())
    weight = 1 / np.maximum(np.linalg.norm(face[pairs[:, 0]] - face[pairs[:, 1]], axis=1), 1e-6)
    graph = np.zeros((MESH_SIZE, MESH_SIZE))
    graph[pairs[:, 0], pairs[:, 1]] = graph[pairs[:, 1], pairs[:, 0]] = weight
    laplacian = np.diag(graph.sum(axis=1)) - graph
    held = (face[:, 1] <= face[NOSE_BASE_VERTEX, 1]) | (graph.sum(axis=1) == 0)
    held[list(FACE_OVAL)] = held[vertices] = True
    given = np.zeros((MESH_SIZE, moved.shape[1]))
    given[vertices] = moved
    free = ~held
    given[free] = np.linalg.solve(laplacian[np.ix_(free, free)], -laplacian[np.ix_(free, held)] @ given[held])
    return given
