"""A shell bound to its skeleton: it comes from the template, and so its weights and the way to T-pose are known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.rest_skeleton import pictured_joints
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.rig.rigging import Character, pictured_clip
from engine.character.shell.shell import Shell
from engine.geometry.skinned_mesh import SkinnedMesh


def bind_shell(shell: Shell, camera: PictureCamera, fitted: FittedBody, texture: NDArray[np.uint8]) -> Character:
    """The character of a shell, with a texture (H, W, 3) in the template's chart. `camera`: the grid's."""
    mesh, corners = shell.mesh, shell.mesh.corners
    lowest = camera.to_metres(shell.pictured)[:, 1].min()
    eye = np.array([0.0, -lowest, camera.distance])
    joints = pictured_joints(fitted, load_human().space).seen_from(eye)
    lift = np.array([0.0, -shell.rest[:, 1].min(), 0.0])
    bound = SkinnedMesh(
        joints.lifted(lift),
        (shell.rest + lift)[corners].astype(np.float32),
        mesh.uv_triangles,
        mesh.uv,
        mesh.bones[corners].astype(np.uint8),
        mesh.weights[corners],
        texture,
    )
    return Character(bound, pictured_clip(joints), eye)
