"""Clips changed: in place, with parts kept as pictured, loops played for as long as wanted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip, loop_step
from engine.motion.feet.foot_contact import sole_places
from engine.motion.feet.legs import HeldFoot, set_legs
from engine.motion.feet.sole import soles
from engine.motion.kinematics import local_rotations, place_joints, world_rotations

Array = NDArray[np.float64]

_ARM_JOINTS = ("Shoulder", "Arm", "ForeArm", "Hand")
_LEG_JOINTS = ("UpLeg", "Leg", "Foot", "ToeBase")

KEPT_PART_JOINTS: dict[str, tuple[str, ...]] = {
    "head": ("Neck", "Head"),
    "torso": ("Spine", "Spine1", "Spine2"),
    "left_arm": tuple(f"Left{part}" for part in _ARM_JOINTS),
    "right_arm": tuple(f"Right{part}" for part in _ARM_JOINTS),
    "left_leg": tuple(f"Left{part}" for part in _LEG_JOINTS),
    "right_leg": tuple(f"Right{part}" for part in _LEG_JOINTS),
}
"""What can be kept as pictured, and its joints; fingers go with their arm. Besides: `arms` and `legs`, both sides."""


def in_place(clip: Clip) -> Clip:
    """The clip without its travel over the ground: a loop without its even way, another clip without the way that is
    left when everything quicker than a second is smoothed out. What the body sways stays."""
    root = np.asarray(clip.root, np.float64)
    if clip.loops:
        way = loop_travel(clip) * (np.arange(len(root)) / len(root))[:, None]
    else:
        way = gaussian_filter1d(root, 0.5 * clip.fps, axis=0, mode="nearest")
        way -= way[0]
    return replace(clip, root=(root - way * [1, 0, 1]).astype(np.float32))


def loop_travel(clip: Clip) -> Array:
    """(3,) how far a loop's root gets in one round, metres; level."""
    return np.asarray((clip.root[-1] - clip.root[0] + loop_step(clip)) * [1, 0, 1], np.float64)


def keep_pictured_parts(skeleton: Skeleton, clip: Clip, pictured: Clip, parts: Sequence[str]) -> Clip:
    """The clip with some parts of the body as in the pictured pose (the first frame of `pictured`), seen from the part
    that carries them. With both legs kept, hips and root stay as pictured as well; with one, it is dragged along.

    Raises
    ------
    ValueError : there is no such part in `KEPT_PART_JOINTS`.
    """
    wanted = {part for name in parts for part in _parts(name)}
    joints = {joint for part in wanted for joint in KEPT_PART_JOINTS[part]}
    rotations, root = clip.rotations.copy(), clip.root.copy()
    if {"left_leg", "right_leg"} <= wanted:
        joints.add("Hips")
        root[:] = pictured.root[0]
    for index, name in enumerate(skeleton.names):
        finger = any(name.startswith(f"{side}Hand") and f"{side}Hand" in joints for side in SIDE_NAMES)
        if name in joints or finger:
            rotations[:, index] = pictured.rotations[0, index]
    kept = replace(clip, rotations=rotations, root=root)
    legs = [leg in wanted for leg in ("left_leg", "right_leg")]
    return _dragging(skeleton, clip, kept, legs.index(True)) if legs.count(True) == 1 else kept


def _dragging(skeleton: Skeleton, clip: Clip, kept: Clip, side: int) -> Clip:
    """`kept`, whose leg on one side (0 left, 1 right) is not the clip's, with its lowest sole as high as the clip's is. Where
    that raises the body, the other foot stays where it is in the clip, as far as its leg reaches."""
    lowest, wanted = (sole_places(skeleton, one)[..., 1].min((1, 2)) for one in (kept, clip))
    up = np.array([0.0, 1.0, 0.0])
    root = kept.root + (wanted - lowest)[:, None] * up
    world = world_rotations(skeleton.parents, kept.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, root)
    sole = soles(skeleton)[1 - side]
    ankle, toe = sole.joints[2:]
    there = places[:, ankle] - np.maximum(wanted - lowest, 0)[:, None] * up
    set_legs(world, places, [(sole, HeldFoot(world[:, ankle], world[:, toe], there, np.ones(len(root))))])
    leg = [joint for joint in sole.joints if joint >= 0]
    rotations = kept.rotations.copy()
    rotations[:, leg] = local_rotations(skeleton.parents, world)[:, leg]
    return replace(kept, rotations=rotations, root=root.astype(np.float32))


def _parts(name: str) -> tuple[str, ...]:
    if name in ("arms", "legs"):
        return f"left_{name[:-1]}", f"right_{name[:-1]}"
    if name not in KEPT_PART_JOINTS:
        raise ValueError(f"there is no part {name!r}: choose among {', '.join(KEPT_PART_JOINTS)}, arms, legs")
    return (name,)


def repeat_loop(clip: Clip, frames: int, start: int = 0) -> Clip:
    """`frames` frames of a loop from frame `start` on, travelling on from round to round; it loops no more. A clip that
    does not loop stays in its last frame."""
    wanted = start + np.arange(frames)
    if not clip.loops:
        chosen = np.minimum(wanted, len(clip.rotations) - 1)
        return replace(clip, rotations=clip.rotations[chosen], root=clip.root[chosen])
    rounds, chosen = np.divmod(wanted, len(clip.rotations))
    root = clip.root[chosen] + rounds[:, None] * loop_travel(clip)
    return replace(clip, rotations=clip.rotations[chosen], root=root.astype(np.float32), loops=False)
