"""The fitted skin's skeleton, and its T-pose: section 3.4, "joint positions through mean value coordinates"."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton

MIN_BLEND_STRETCH_RATIO, MAX_BLEND_STRETCH_RATIO = 0.5, 2.0
"""Least and most by which the blend of the joints' turns may shrink or stretch a place, in any direction, when it is
undone. Where very different turns meet, as under raised arms, the blend is nearly flat and its inverse explodes."""


@dataclass(frozen=True)
class Pose:
    """A pose of joints: `joints` (J, 3) places, metres, and `rotations` (J, 3, 3): how each one's axes are turned from the
    T-pose, in the world."""

    joints: NDArray[np.float64]
    rotations: NDArray[np.float64]


def rest_joints(pose: Pose, parents: NDArray[np.integer]) -> NDArray[np.float64]:
    """(J, 3) the joints in T-pose, the root where it is in the pose: every bone as long as in the pose, turned back."""
    rest = pose.joints.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            rest[joint] = rest[parent] + pose.rotations[parent].T @ (pose.joints[joint] - pose.joints[parent])
    return rest


def unposed(
    vertices: NDArray[np.floating],
    bones: NDArray[np.integer],
    weights: NDArray[np.floating],
    pose: Pose,
    rest: NDArray[np.floating],
) -> NDArray[np.float64]:
    """Vertices (V, 3) in a pose brought to T-pose with the joints `rest` (J, 3): linear blend skinning by `bones` and `weights`
    (V, K) undone."""
    shifts = pose.joints - np.einsum("jab,jb->ja", pose.rotations, rest)
    blended = np.einsum("vk,vkab->vab", weights, pose.rotations[bones])
    moved = np.einsum("vk,vka->va", weights, shifts[bones])
    left, spread, right = np.linalg.svd(blended)
    spread = np.clip(spread, MIN_BLEND_STRETCH_RATIO, MAX_BLEND_STRETCH_RATIO)
    back = right.transpose(0, 2, 1) / spread[:, None, :] @ left.transpose(0, 2, 1)
    return np.asarray(np.einsum("vab,vb->va", back, vertices - moved))


def on_the_ground(
    vertices: NDArray[np.floating],
    joints: NDArray[np.floating],
    standing: NDArray[np.integer],
    names: tuple[str, ...],
    parents: NDArray[np.int32],
) -> tuple[NDArray[np.float32], Skeleton]:
    """Vertices (V, 3) and joints (J, 3) shifted so that the lowest of the vertices `standing` is at y = 0 and the root above
    the origin; the joints as a skeleton."""
    shift = np.array([joints[0, 0], vertices[standing, 1].min(), joints[0, 2]])
    skeleton = Skeleton(names, parents, (joints - shift).astype(np.float32))
    return (vertices - shift).astype(np.float32), skeleton
