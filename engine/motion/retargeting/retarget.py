"""Motions of other skeletons, carried over to ours.

World rotations are carried over, measured from where both skeletons stand in the same T-pose (`reference_pose`); the
hips' way is scaled by the length of the legs. What leads into itself becomes a loop (`looping`), and what walks in
place walks on (`treadmill`). What differs in proportion is then mended where it shows: at the feet (`foot_contact`).
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.feet.foot_contact import FeetReport
from engine.motion.feet.foot_hold import hold_feet
from engine.motion.feet.sole import leg_length
from engine.motion.files.source_motion import SourceMotion
from engine.motion.kinematics import local_rotations
from engine.motion.retargeting.glitches import without_flips
from engine.motion.retargeting.joint_map import map_joints, not_humanoid
from engine.motion.retargeting.looping import as_loop
from engine.motion.retargeting.reference_pose import t_pose_rotations
from engine.motion.retargeting.resampling import resample_source
from engine.motion.retargeting.treadmill import travel_as_walked

Array = NDArray[np.float64]

Facing = Literal["start", "main", "keep"]

MIN_LEG_SHARE = 0.05
"""Thigh and shin of somebody, as a share of the way from the hips to the farthest of their joints: the legs of any figure
are longer, and by those that are not no way can be measured."""


@dataclass(frozen=True)
class RetargetResult:
    """A motion carried over: the clip, which joint moved which (`{ours: the motion's}`), and how well the feet stand."""

    clip: Clip
    mapping: dict[str, str]
    feet: FeetReport


def retarget(
    motion: SourceMotion,
    skeleton: Skeleton,
    mapping: Mapping[str, str | None] | None = None,
    fps: float = 30.0,
    facing: Facing = "start",
    feet: bool = True,
) -> RetargetResult:
    """Carry a motion over to `skeleton`.

    Parameters
    ----------
    mapping : overrides of the automatic mapping (`engine.motion.retargeting.joint_map.map_joints`).
    fps : frames a second wanted.
    facing : the character looks along +z in the first second (`start`), most of the time (`main`), or where it looked
        (`keep`). It begins over the skeleton's own place at rest.
    feet : hold the feet where they touch the ground.

    Raises
    ------
    InputError : see `map_joints` and `clean_motion`.
    """
    joints = map_joints(motion, mapping)
    motion, upright = clean_motion(motion, joints)
    source = resample_source(motion, fps)
    rotations, places = source.world()
    rotations, places = rotation.multiply(upright, rotations), rotation.rotate(upright, places)
    world = _carry_rotations(rotations, t_pose_rotations(source, joints, skeleton), source.names, joints, skeleton)
    root = _carry_root(places, source.names, joints, skeleton, world)
    turn = _facing_rotation(world[:, skeleton.index("Hips")], facing, fps)
    world, root = rotation.multiply(turn, world), rotation.rotate(turn, root)
    start = skeleton.heads[skeleton.index("Hips")] - root[0]
    root = root + start * [1, 0, 1]
    loops = bool(source.loops) and len(root) > 1
    frames = len(root) - 1 if loops else len(root)
    clip = Clip(
        name=motion.name,
        fps=float(fps),
        rotations=local_rotations(skeleton.parents, world[:frames]).astype(np.float32),
        root=root[:frames].astype(np.float32),
        loops=loops,
    )
    clip, report = hold_feet(skeleton, travel_as_walked(skeleton, clip), hold=feet)
    return RetargetResult(clip, joints, report)


def clean_motion(motion: SourceMotion, joints: Mapping[str, str]) -> tuple[SourceMotion, Array]:
    """The motion without joints that flip over, as a loop if it is one; and its `world_upright`.

    Raises
    ------
    InputError : `motion_not_humanoid`, the legs have no length (see `map_joints`).
    """
    motion = without_flips(motion)
    places = motion.world()[1]
    _require_legs(motion, joints, places)
    upright = world_upright(motion, joints, places)
    heights = rotation.rotate(upright, places[:, motion.names.index(joints["Hips"])])[:, 1]
    return as_loop(motion, heights / _leg_length(places, motion.names, joints)), upright


def world_upright(motion: SourceMotion, joints: Mapping[str, str], places: Array) -> Array:
    """(4,) the rotation of the motion's world that brings its vertical to y. The vertical is where heads are, seen from
    the feet, over all frames; it is y where that is in doubt, or where the format says so."""
    if motion.up is not None:
        return rotation.between(motion.up, (0.0, 1.0, 0.0))
    at = {
        name: places[:, motion.names.index(joints[name])] for name in ("LeftFoot", "RightFoot", "LeftArm", "RightArm")
    }
    tall = np.mean(at["LeftArm"] + at["RightArm"] - at["LeftFoot"] - at["RightFoot"], axis=0)
    tall = rotation.normalize(tall)
    if tall[1] > 0.6:
        return rotation.identity()
    axis = np.zeros(3)
    axis[np.argmax(np.abs(tall))] = np.sign(tall[np.argmax(np.abs(tall))])
    return rotation.between(axis, (0.0, 1.0, 0.0)) if np.abs(tall).max() > 0.6 else rotation.identity()


def _carry_rotations(
    rotations: Array, standing: dict[str, Array], names: tuple[str, ...], joints: Mapping[str, str], skeleton: Skeleton
) -> Array:
    """(F, J, 4) world rotations of our joints; joints without a counterpart stand halfway between those that have one
    (within the spine) or go with their parents."""
    world = rotation.identity(len(rotations), len(skeleton.names))
    for joint, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if name in joints:
            moved = rotations[:, names.index(joints[name])]
            world[:, joint] = rotation.multiply(moved, rotation.inverse(standing[name]))
        elif parent >= 0:
            world[:, joint] = world[:, parent]
    spine = [skeleton.index(name) for name in ("Hips", "Spine", "Spine1", "Spine2") if name in skeleton.names]
    known = [place for place, joint in enumerate(spine) if skeleton.names[joint] in joints]
    for before, after in itertools.pairwise(known):
        for place in range(before + 1, after):
            share = np.full(len(world), (place - before) / (after - before))
            world[:, spine[place]] = rotation.slerp(world[:, spine[before]], world[:, spine[after]], share)
    return world


def _carry_root(
    places: Array, names: tuple[str, ...], joints: Mapping[str, str], skeleton: Skeleton, world: Array
) -> Array:
    """(F, 3) the root's way: the middle between the hip joints goes the source's way, scaled by the legs' length."""
    left, right = (places[:, names.index(joints[name])] for name in ("LeftUpLeg", "RightUpLeg"))
    middle = (left + right) / 2 * (leg_length(skeleton) / _leg_length(places, names, joints))
    heads = np.asarray(skeleton.heads, np.float64)
    hips = skeleton.index("Hips")
    ours = (heads[skeleton.index("LeftUpLeg")] + heads[skeleton.index("RightUpLeg")]) / 2 - heads[hips]
    return np.asarray(middle - rotation.rotate(world[:, hips], ours))


def _leg_length(places: Array, names: tuple[str, ...], joints: Mapping[str, str]) -> float:
    """Thigh and shin of the source, in its own unit: the mean of both legs."""
    at = {name: places[:, names.index(source)] for name, source in joints.items()}
    sides = SIDE_NAMES
    thighs = [np.linalg.norm(at[f"{side}Leg"] - at[f"{side}UpLeg"], axis=1) for side in sides]
    shins = [np.linalg.norm(at[f"{side}Foot"] - at[f"{side}Leg"], axis=1) for side in sides]
    return float(np.median(np.mean(thighs, axis=0) + np.mean(shins, axis=0)))


def _require_legs(motion: SourceMotion, joints: Mapping[str, str], places: Array) -> None:
    mapped = places[:, [motion.names.index(source) for source in joints.values()]]
    hips = places[:, motion.names.index(joints["Hips"]), None]
    reach = float(np.median(np.linalg.norm(mapped - hips, axis=-1).max(1)))
    legs = _leg_length(places, motion.names, joints)
    if legs <= MIN_LEG_SHARE * reach:
        raise not_humanoid(
            motion,
            joints,
            "The motion's legs have hardly any length: say which joints are theirs, or send another file.",
        )


def _facing_rotation(hips: Array, facing: Facing, fps: float) -> Array:
    """(4,) the rotation about the vertical that makes the hips look along +z; hips swing while one walks, so that how
    one starts is what the first second says."""
    forward = rotation.normalize(rotation.rotate(hips, (0.0, 0.0, 1.0)) * [1, 0, 1])
    look = np.mean(forward[: max(round(fps), 1)] if facing == "start" else forward, axis=0)
    if facing == "keep" or np.linalg.norm(look) < 1e-3:
        return rotation.identity()
    return rotation.about("y", -np.arctan2(look[0], look[2]))
