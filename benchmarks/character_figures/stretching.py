"""How far motion stretches a character."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.geometry.rigging.skinning import skin
from engine.motion.kinematics import pose_transforms
from engine.motion.library import built_in

STRETCH_RATIO = 3.0
"""How many times its pictured length an edge has from which it is stretched."""
STRETCHED_FRAME_STEP = 5
"""Frames from one that is looked at to the next."""


def stretched(character: Character, name: str) -> float:
    """The share of edges that the worst frame of a built-in clip makes more than `STRETCH_RATIO` times as long as pictured."""
    mesh = character.mesh
    edges = all_edges(mesh.triangles)

    def lengths(vertices: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)

    before = np.maximum(lengths(pose(character, character.pictured)), 1e-4)
    clip = built_in(name, mesh.skeleton)
    return max(
        float((lengths(skin(mesh.vertices, mesh.bones, mesh.weights, transforms)) > STRETCH_RATIO * before).mean())
        for transforms in pose_transforms(
            mesh.skeleton, clip.rotations[::STRETCHED_FRAME_STEP], clip.root[::STRETCHED_FRAME_STEP]
        )
    )


def all_edges(triangles: NDArray[np.integer]) -> NDArray[np.integer]:
    """(E, 2) each edge of the triangles (T, 3) once."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(sides, 1), axis=0)
