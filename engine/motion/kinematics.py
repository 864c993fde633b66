"""Forward kinematics over all frames of a clip at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.compiled import njit
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.half_turns import with_half_turns

Array = NDArray[np.float64]


def world_rotations(parents: NDArray[np.integer], rotations: ArrayLike) -> Array:
    """(..., J, 4) rotations of joints in the world, from their rotations in their parents' axes."""
    world = np.array(rotations, np.float64, order="C")
    _turn_with_parents(np.ascontiguousarray(parents, np.int32), world.reshape(-1, *world.shape[-2:]))
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
    rotations = np.array(world, np.float64, order="C")
    places = np.array(np.broadcast_to(offsets, (*rotations.shape[:-1], 3)), np.float64, order="C")
    parents = np.ascontiguousarray(parents, np.int32)
    places[..., parents < 0, :] = np.asarray(root, np.float64)[..., None, :]
    _move_with_parents(parents, rotations.reshape(-1, *rotations.shape[-2:]), places.reshape(-1, *places.shape[-2:]))
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


@njit(nogil=True, boundscheck=False)  # no fastmath: the same turns, bit by bit, as `rotation.multiply` makes
def _turn_with_parents(parents: np.ndarray, rotations: np.ndarray) -> None:
    """Rotations (N, J, 4) in parents' axes become those in the world, in place; parents come before their children."""
    for n in range(len(rotations)):
        for joint in range(len(parents)):
            if parents[joint] < 0:
                continue
            ax, ay, az, aw = rotations[n, parents[joint]]
            bx, by, bz, bw = rotations[n, joint]
            rotations[n, joint, 0] = aw * bx + ax * bw + ay * bz - az * by
            rotations[n, joint, 1] = aw * by - ax * bz + ay * bw + az * bx
            rotations[n, joint, 2] = aw * bz + ax * by - ay * bx + az * bw
            rotations[n, joint, 3] = aw * bw - ax * bx - ay * by - az * bz


@njit(nogil=True, boundscheck=False)  # as `rotation.rotate` turns
def _move_with_parents(parents: np.ndarray, rotations: np.ndarray, places: np.ndarray) -> None:
    """Ways (N, J, 3) from parents, in the axes of these, become places, in place; parents come before their children."""
    for n in range(len(places)):
        for joint in range(len(parents)):
            if parents[joint] < 0:
                continue
            x, y, z, w = rotations[n, parents[joint]]
            vx, vy, vz = places[n, joint]
            tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
            places[n, joint, 0] = places[n, parents[joint], 0] + (vx + w * tx + (y * tz - z * ty))
            places[n, joint, 1] = places[n, parents[joint], 1] + (vy + w * ty + (z * tx - x * tz))
            places[n, joint, 2] = places[n, parents[joint], 2] + (vz + w * tz + (x * ty - y * tx))
