"""A motion kept within a room: whoever walks on towards its end takes shorter and shorter steps, and treads on the spot.

Every place on the ground is moved by one map that depends on the place alone, not on the time. What stands in the motion
stands in the new one by construction, wherever the map puts it: nothing skates. The map leaves places near the beginning
where they are, and draws all others towards the ends of the room without passing them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.feet.foot_contact import sole_places
from engine.motion.feet.legs import HeldFoot, hip_lowering, set_legs
from engine.motion.feet.sole import soles
from engine.motion.kinematics import local_rotations, place_joints, world_rotations

Array = NDArray[np.float64]

FREE_MOTION_SHARE = 0.5
"""The share of the room in which places stay where they are."""

TURNING_METRES = 0.5
"""Metres of travel within which somebody with no room at all ahead comes back."""

STANCE_METRES = 0.6
"""Metres of travel after which a foot goes where the other goes, however far apart they stood at the beginning."""


@dataclass(frozen=True)
class MovementRoom:
    """How far the hips may get from where they are in the first frame, metres along the axes of the world: `ahead` (z) and
    `behind` (-z), `left` (x) and `right` (-x). Fewer than none is a way back that is to be made."""

    ahead: float
    behind: float
    left: float
    right: float


def confine_clip(skeleton: Skeleton, clip: Clip, room: MovementRoom, leap: float = 1.0) -> Clip:
    """The clip within a room, its first frame as it is. Of leaps, when no foot is on the ground, `leap` of the height is left."""
    world = world_rotations(skeleton.parents, clip.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    lowest = np.maximum(sole_places(skeleton, clip)[..., 1].min((1, 2)), 0)
    sunk = (1 - leap) * (lowest - lowest[0])[:, None] * [0, 1, 0]
    begin = places[0, 0]
    root = begin + _drawn(places[:, 0] - begin, room)
    feet, moved = [], float(np.abs(root - places[:, 0]).max())
    for sole in soles(skeleton):
        ankle, toe = sole.joints[2:]
        rotations, toes = world[:, ankle], world[:, toe if toe >= 0 else ankle]
        joint = places[:, ankle] + rotation.rotate(rotations, sole.toe)
        there = begin + _drawn(joint - begin, room)
        own = np.linalg.norm((joint - joint[0])[:, [0, 2]], axis=1)
        there = there + (joint[0] - there[0]) * _fading(own / STANCE_METRES)[:, None]
        moved = max(moved, float(np.abs(there - joint).max()))
        held = HeldFoot(rotations, toes, there - rotation.rotate(rotations, sole.toe) - sunk, np.ones(len(root)))
        feet.append((sole, held))
    if moved < 1e-4 and not sunk.any():
        return clip
    root = root - sunk
    times = np.arange(len(root)) / clip.fps
    down = hip_lowering(feet, place_joints(skeleton.parents, skeleton.offsets(), world, root), clip.fps)
    root = root - (down * np.minimum(times / 0.2, 1))[:, None] * [0, 1, 0]
    set_legs(world, place_joints(skeleton.parents, skeleton.offsets(), world, root), feet)
    local = local_rotations(skeleton.parents, world).astype(np.float32)
    local[0] = clip.rotations[0]
    return replace(clip, rotations=local, root=root.astype(np.float32), loops=False)


def _drawn(way: Array, room: MovementRoom) -> Array:
    """Ways (F, 3) from the beginning, drawn into the room; heights stay."""
    x, y, z = way.T
    across = np.where(x > 0, _saturated(x, room.left), -_saturated(-x, room.right))
    deep = np.where(z > 0, _saturated(z, room.ahead), -_saturated(-z, room.behind))
    return np.stack([across, y, deep], 1)


def _saturated(way: Array, room: float) -> Array:
    """Where a way (F,), not below 0 where it counts, ends: itself at first, at most `room` in the end, smooth between."""
    if room <= 0:
        return room * -np.expm1(-np.maximum(way, 0) / TURNING_METRES)
    rest = (1 - FREE_MOTION_SHARE) * room
    beyond = np.maximum(way - FREE_MOTION_SHARE * room, 0)
    return np.minimum(way, FREE_MOTION_SHARE * room) + rest * -np.expm1(-beyond / rest)


def _fading(share: Array) -> Array:
    u = np.clip(share, 0, 1)
    return np.asarray(1 - u * u * (3 - 2 * u))
