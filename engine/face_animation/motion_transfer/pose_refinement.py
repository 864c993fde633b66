"""The head's pose by its hair as well as by its face.

A tracker sees turns of the face too small and takes a smile for a tilt: the depth that it gives is a guess, and a jaw that opens and cheeks
that rise move what the pose is fitted to. Hair does neither, and lies where a tilt shows most. So the tracked points above and beside the
face, on the skull of `head_proxy`, have their say in the pose; what the face does beyond it is its expression.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.body_motion import MIN_TRUSTED_POINTS, hair_share
from engine.face_animation.motion_transfer.head_motion import HeadMotion, with_expression
from engine.face_animation.motion_transfer.head_proxy import HeadProxy, chin_length, followed_outline, move_head
from engine.face_animation.motion_transfer.head_room import skull_centre, skull_shift
from engine.perception.face.landmarks import MESH_SIZE, RIGID_VERTICES

HAIR_WEIGHT, RIGID_DEPTH_WEIGHT = 1.5, 2.0
"""What all tracked points of the hair together, and the depths of the face's rigid vertices, count against 1 for where those lie in the picture."""
HAIR_SIGMA_CHIN_LENGTHS = 0.1
"""Lengths from eyes to chin: points of the hair further away from where the pose has them have slipped, and count ever less."""
GAUSS_NEWTON_STEPS = 2
"""Of the least squares, for each frame."""


def refine_pose(
    motion: HeadMotion,
    proxy: HeadProxy,
    meshes: NDArray[np.floating],
    moved: NDArray[np.floating],
    trust: NDArray[np.floating],
) -> HeadMotion:
    """The head's motion of a driver with a pose that its hair agrees with; where no hair is tracked, as it is.

    Parameters
    ----------
    motion : by the face alone, see `split_motion`. proxy : the driver's neutral face with K tracked points around it.
    meshes : (N, 478, 3) what the motion was taken of, pixels. moved : (N, K, 2) offsets of the tracked points. trust : (N, K) [0, 1].
    """
    places = proxy.points[MESH_SIZE:, :2]
    if not len(places):
        return motion
    neutral, rigid = motion.neutral, list(RIGID_VERTICES)
    hair = trust * proxy.share[MESH_SIZE:] * hair_share(neutral, places)
    hair *= HAIR_WEIGHT / np.maximum(hair.sum(axis=1), MIN_TRUSTED_POINTS)[:, None]
    seen = meshes[:, rigid].astype(float)
    for _ in range(GAUSS_NEWTON_STEPS):
        middle = skull_centre(neutral) + skull_shift(motion)
        face = (
            motion.scale[:, None, None] * (neutral[rigid] @ motion.rotation.transpose(0, 2, 1)) + motion.shift[:, None]
        )
        skull = move_head(proxy, motion, neutral)[:, MESH_SIZE:].astype(float)
        off = places + moved - skull[..., :2]
        slipped = np.linalg.norm(off, axis=2) / (HAIR_SIGMA_CHIN_LENGTHS * chin_length(neutral))
        equations = _NormalEquations(len(meshes))
        share = np.full(face.shape[:2], 1 / len(rigid))
        across, down, deep = _derivatives(face - middle[:, None], np.zeros(len(rigid)))
        depth = seen[..., 2] - face[..., 2]
        equations.add(across, seen[..., 0] - face[..., 0], share)
        equations.add(down, seen[..., 1] - face[..., 1], share)
        equations.add(_centred(deep), _centred(depth), RIGID_DEPTH_WEIGHT * share)
        outline = followed_outline(proxy, motion.rotation, skull_centre(neutral))[:, MESH_SIZE:]
        across, down, _ = _derivatives(skull - middle[:, None], outline)
        believed = hair / (1 + slipped**2) ** 2  # Geman and McClure
        equations.add(across, off[..., 0], believed)
        equations.add(down, off[..., 1], believed)
        motion = _stepped(motion, equations.solved())
    return with_expression(motion, meshes)


class _NormalEquations:
    """Least squares of N frames at once, for turns about x, y and z, the logarithm of the scale, and shifts along x and y."""

    def __init__(self, frames: int):
        self._squares, self._right = np.zeros((frames, 6, 6)), np.zeros((frames, 6))

    def add(self, rows: NDArray[np.float64], off: NDArray[np.float64], weight: NDArray[np.floating]) -> None:
        """Rows (N, V, 6) that are to make up for `off` (N, V), which count by `weight` (N, V)."""
        weighted = weight[..., None] * rows
        self._squares += weighted.transpose(0, 2, 1) @ rows
        self._right += np.einsum("nvi,nv->ni", weighted, off)

    def solved(self) -> NDArray[np.float64]:
        """(N, 6)."""
        return np.asarray(np.linalg.solve(self._squares, self._right[..., None])[..., 0])


def _derivatives(
    arm: NDArray[np.float64], outline: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """By the pose, of x, y and depth of points at `arm` (N, V, 3) from the head's middle, which go with the `outline` (V,) or (N, V): each (N, V, 6)."""
    x, y, z = np.moveaxis(arm, -1, 0)
    turned, none, one = (1 - outline) * z, np.zeros_like(x), np.ones_like(x)
    across = np.stack([none, turned, -y, x, one, none], axis=-1)
    down = np.stack([-turned, none, x, y, none, one], axis=-1)
    return across, down, np.stack([y, -x, none, z, none, none], axis=-1)


def _centred(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Depths (N, V, ...) about their mean: how far off the camera a face is nobody knows."""
    return np.asarray(values - values.mean(axis=1, keepdims=True))


def _stepped(motion: HeadMotion, step: NDArray[np.float64]) -> HeadMotion:
    """The motion with the head turned, scaled and shifted by `step` (N, 6) about its middle."""
    centre = skull_centre(motion.neutral)
    away = skull_shift(motion)
    away[:, :2] += step[:, 4:]
    rotation = np.array([cv2.Rodrigues(turn)[0] for turn in step[:, :3]]) @ motion.rotation
    scale = motion.scale * np.exp(step[:, 3])
    return replace(motion, rotation=rotation, scale=scale, shift=away + centre - scale[:, None] * (rotation @ centre))
