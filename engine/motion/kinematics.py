"""Forward kinematics over all frames of a clip at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.half_turns import with_half_turns

Array = NDArray[np.float64]


def world_rotations(parents: NDArray[np.integer], rotations: ArrayLike) -> Array:
    """(..., J, 4) rotations of joints in the world, from their rotations in their parents' axes."""
    local = np.asarray(rotations, np.float64)
    world = local.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            world[..., joint, :] = rotation.multiply(world[..., parent, :], local[..., joint, :])
    return world


def local_rotations(parents: NDArray[np.integer], world: ArrayLike) -> Array:
    """(..., J, 4) rotations of joints in their parents' axes, from their rotations in the world."""
    rotations = np.asarray(world, np.float64)
    own = rotation.multiply(rotation.inverse(rotations[..., np.maximum(parents, 0), :]), rotations)
    own[..., parents < 0, :] = rotations[..., parents < 0, :]
    return rotation.normalize(own)


def place_joints(parents: NDArray[np.integer], offsets: ArrayLike, world: ArrayLike, root: ArrayLike) -> Array:
    """(..., J, 3) places of joints, from world rotations (..., J, 4), offsets in parents' axes (..., J, 3) and the
    root's place (..., 3)."""
    rotations, steps = np.asarray(world, np.float64), np.asarray(offsets, np.float64)
    places = np.empty((*rotations.shape[:-1], 3))
    for joint, parent in enumerate(parents):
        if parent < 0:
            places[..., joint, :] = root
        else:
            places[..., joint, :] = places[..., parent, :] + rotation.rotate(
                rotations[..., parent, :], steps[..., joint, :]
            )
    return places


def joint_places(skeleton: Skeleton, clip: Clip) -> Array:
    """(F, J, 3) where the joints are in each frame, metres."""
    world = world_rotations(skeleton.parents, clip.rotations)
    return place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)


def world_transforms(skeleton: Skeleton, clip: Clip) -> Array:
    """(F, J, 4, 4) each joint's axes and place in the world: what a joint's own coordinates are multiplied with.

    For skinning, take off the rest pose: the matrix of joint j acts on `vertices - skeleton.heads[j]`.
    """
    world = world_rotations(skeleton.parents, clip.rotations)
    matrices = np.zeros((*world.shape[:-1], 4, 4))
    matrices[..., :3, :3] = rotation.to_matrix(world)
    matrices[..., :3, 3] = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    matrices[..., 3, 3] = 1
    return matrices


def pose_transforms(
    skeleton: Skeleton, rotations: NDArray[np.floating], root: NDArray[np.floating]
) -> NDArray[np.float32]:
    """What each joint does to the rest pose, (F, J, 4, 4) float32, acting on column vectors.

    Parameters
    ----------
    rotations : (F, J, 4) unit quaternions (x, y, z, w): each joint's rotation from the T-pose in its parent's axes, as
        in `engine.motion.clip.Clip`. Half joints (`engine.geometry.rigging.half_joints`) turn as their whole ones tell.
    root : (F, 3) the root joint's places, metres.
    """
    world = world_rotations(skeleton.parents, with_half_turns(skeleton, rotations))
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    matrices = rotation.to_matrix(world)
    transforms = np.zeros((*matrices.shape[:2], 4, 4), np.float32)
    transforms[..., :3, :3] = matrices
    transforms[..., :3, 3] = places - np.einsum("fjik,jk->fji", matrices, skeleton.heads.astype(np.float64))
    transforms[..., 3, 3] = 1
    return transforms
