"""A displaced template at rest. Nothing is inverted: what blending crushes, the way back from it would burst."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.rest_skeleton import kept_transforms, pictured_joints
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.shell.template_mesh import TemplateMesh
from engine.geometry.nearest_rotations import nearest_rotations

CORRECTION_ROUNDS, MAX_CORRECTION_METRES = 6, 0.012
"""How often what blending leaves of a displacement is looked at and corrected, and by how many metres at most in all."""


def shell_at_rest(
    mesh: TemplateMesh,
    straight: NDArray[np.floating],
    template: NDArray[np.float64],
    pictured: NDArray[np.float64],
    camera: PictureCamera,
    fitted: FittedBody,
) -> NDArray[np.float64]:
    """Vertices (V, 3) at rest, metres, that the pictured joints bring to `pictured` (V, 3) of picture space, to within what
    `MAX_CORRECTION_METRES` leaves where blending crushes.

    `straight` (V, 3): the template in T-pose, and `template` (V, 3) in the picture, not displaced. The template at rest is known;
    of the displacement each vertex's goes back by the rotation that is nearest to its blended transform.
    """
    space = load_human().space
    rest = _moved(_blended(mesh, kept_transforms(fitted, space)), straight)
    transforms = _blended(mesh, pictured_joints(fitted, space).transforms())
    back = nearest_rotations(transforms[:, :3, :3])
    goal = camera.to_metres(pictured)
    rest = rest + _turned(back, goal - camera.to_metres(template))
    more = np.zeros_like(rest)
    for _ in range(CORRECTION_ROUNDS):
        more += _turned(back, goal - _moved(transforms, rest + more))
        far = np.linalg.norm(more, axis=1, keepdims=True)
        more *= np.minimum(1, MAX_CORRECTION_METRES / np.maximum(far, MAX_CORRECTION_METRES))
    return np.asarray(rest + more)


def _blended(mesh: TemplateMesh, transforms: NDArray[np.floating]) -> NDArray[np.float64]:
    """(V, 4, 4) what joints' transforms (J, 4, 4) do to each vertex."""
    return np.asarray(
        np.einsum("vk,vkij->vij", mesh.weights.astype(np.float64), transforms[mesh.bones].astype(np.float64))
    )


def _moved(transforms: NDArray[np.float64], places: NDArray[np.floating]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("vij,vj->vi", transforms[:, :3, :3], places) + transforms[:, :3, 3])


def _turned(turns: NDArray[np.float64], ways: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("vij,vj->vi", turns, ways))
