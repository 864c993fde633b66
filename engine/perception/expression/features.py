"""A face's expression in a few numbers, whatever the head's turn."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import fit_similarities
from engine.perception.face.head_pose import canonical_face, mirror_vertices
from engine.perception.face.landmarks import (
    LIPS_INNER,
    LIPS_OUTER,
    RIGID_VERTICES,
    eye_distance,
    eye_opening,
    mouth_opening,
)

EXPRESSION_FEATURES = ("mouth_open", "mouth_wide", "corners_up", "inner_brows_up", "outer_brows_up", "eyes_open")
"""What is measured of an expression, in eye distances of the face turned to the front; the eyes' opening is over
their own width."""

TURNED_CHUNK_FRAMES = 256
"""Meshes that are turned to the front together, so that memory does not grow with a video's length."""


def measure_expression(meshes: NDArray[np.floating]) -> NDArray[np.float32]:
    """`EXPRESSION_FEATURES` of meshes (N, 478, 3) whose heads may be turned: (N, 6)."""
    return np.concatenate(
        [
            _expressed(meshes[start : start + TURNED_CHUNK_FRAMES])
            for start in range(0, len(meshes), TURNED_CHUNK_FRAMES)
        ]
    )


def _expressed(meshes: NDArray[np.floating]) -> NDArray[np.float32]:
    front = frontalise(meshes)
    middle = (front[:, 13] + front[:, 14]) / 2
    corners = (front[:, 61] + front[:, 291]) / 2
    lids = (front[:, 33] + front[:, 133] + front[:, 263] + front[:, 362]) / 4
    wide = np.linalg.norm(front[:, 61] - front[:, 291], axis=1)
    return np.stack(
        [
            mouth_opening(meshes) * wide,
            wide,
            (middle - corners)[:, 1],
            lids[:, 1] - (front[:, 107] + front[:, 336])[:, 1] / 2,
            lids[:, 1] - (front[:, 70] + front[:, 300])[:, 1] / 2,
            eye_opening(meshes).mean(axis=1),
        ],
        axis=1,
    ).astype(np.float32)


def lip_asymmetry(meshes: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, L, 2) by how much the lips' points of meshes (N, 478, 3) lie off the mirror images of those opposite, in eye
    distances of the face turned to the front."""
    lips = list(LIPS_OUTER + LIPS_INNER)
    opposite = mirror_vertices()[lips]

    def off(some: NDArray[np.floating]) -> NDArray[np.float32]:
        front = frontalise(some)[..., :2]
        return np.asarray(front[:, lips] - front[:, opposite] * (-1, 1), np.float32)

    return np.concatenate(
        [off(meshes[start : start + TURNED_CHUNK_FRAMES]) for start in range(0, len(meshes), TURNED_CHUNK_FRAMES)]
    )


def frontalise(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """Meshes (N, 478, 3) turned to the front, the eye distance 1."""
    chosen = list(RIGID_VERTICES)
    scale, rotation, shift = fit_similarities(
        canonical_face()[chosen].astype(float), meshes[:, chosen], np.ones(len(chosen))
    )
    front = np.einsum("nji,nvj->nvi", rotation, meshes - shift[:, None]) / scale[:, None, None]
    return np.asarray(front / eye_distance(front)[:, None, None], float)
