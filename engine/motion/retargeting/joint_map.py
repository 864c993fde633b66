"""Which joint of a motion's skeleton moves which joint of ours: by name, and by shape where names say nothing."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.geometry.rigging.half_joints import is_half_joint
from engine.geometry.rigging.joint_names import FINGER_NAMES, SIDE_NAMES
from engine.motion import rotation
from engine.motion.files.source_motion import SourceMotion
from engine.motion.retargeting.joint_names import SIDED_JOINTS, TARGET_NAMES, match_names
from engine.motion.retargeting.tree_shape import children_of, common_ancestor, match_shape, path

REQUIRED_MOTION_JOINTS = (
    "Hips",
    *(f"{side}{part}" for side in SIDE_NAMES for part in ("UpLeg", "Leg", "Foot", "Arm", "ForeArm")),
)

MIN_TURN_ANGLE = np.radians(3)
"""A joint that turns by less is held."""

MAX_JOINTS_TOLD = 10
"""Names of joints in a refusal, at most."""

JOINT_CHAINS = tuple(
    tuple(side + part for part in chain)
    for side in SIDE_NAMES
    for chain in (
        SIDED_JOINTS[:4],
        SIDED_JOINTS[4:],
        *((f"Hand{f}{n}" for n in "123") for f in FINGER_NAMES),
    )
)


def map_joints(motion: SourceMotion, overrides: Mapping[str, str | None] | None = None) -> dict[str, str]:
    """`{our joint (Mixamo name): the motion's joint}`, in the order of `TARGET_NAMES`; joints without a counterpart
    are left out, and follow their parents.

    `overrides` says otherwise for some of our joints: the motion's joint, or None to leave it out.

    Raises
    ------
    InputError : `motion_joint_unknown`, an override names a joint that is not there; `motion_not_humanoid`, hips, arms
        or legs were not found, or one joint would move several of those that must have one (`found["mapping"]` is what was found,
        `found["joints"]` the motion's joints).
    """
    overrides = dict(overrides or {})
    _check(motion, overrides)
    found = _order_holds(motion.parents, match_names(motion.names))
    if any(name not in found for name in REQUIRED_MOTION_JOINTS):
        found = _completed(motion.parents, found, _by_shape(motion))
    chosen = {name: motion.names.index(joint) for name, joint in overrides.items() if joint is not None}
    found = {name: index for name, index in found.items() if name not in overrides} | chosen
    found = _trunk(motion.parents, found)
    found = {name: index for name, index in found.items() if name not in overrides} | chosen
    mapping = {name: motion.names[found[name]] for name in TARGET_NAMES if name in found}
    missing = [name for name in REQUIRED_MOTION_JOINTS if name not in mapping]
    if missing:
        raise not_humanoid(
            motion,
            mapping,
            f"In the motion's skeleton no joint was found for {', '.join(missing)}: say which they are.",
        )
    _each_its_own(motion, mapping)
    return mapping


def _completed(parents: NDArray[np.int32], said: dict[str, int], shape: dict[str, int]) -> dict[str, int]:
    """What the names said, completed by what the shape tells; where the two are not one person, the shape's limbs with what the
    names said of the rest, such as fingers."""
    kept = set(said.values())
    both = _order_holds(parents, {name: joint for name, joint in shape.items() if joint not in kept} | said)
    if not shape or all(name in both for name in REQUIRED_MOTION_JOINTS):
        return both if shape else said
    taken = set(shape.values())
    return _order_holds(parents, {name: joint for name, joint in said.items() if joint not in taken} | shape)


def lost_joints(motion: SourceMotion, mapping: Mapping[str, str]) -> tuple[str, ...]:
    """The joints that turn in the motion and move nothing: they have no counterpart, nor has any joint below them, which would
    carry on their rotations."""
    mapped = set(mapping.values())
    used = {joint for joint, name in enumerate(motion.names) if name in mapped}
    for joint in range(len(motion.parents) - 1, -1, -1):
        if joint in used and motion.parents[joint] >= 0:
            used.add(int(motion.parents[joint]))
    change = rotation.multiply(rotation.inverse(motion.rotations[:1]), motion.rotations)
    rotating = rotation.angle(change).max(0) > MIN_TURN_ANGLE
    return tuple(
        name
        for joint, name in enumerate(motion.names)
        if rotating[joint] and joint not in used and not is_half_joint(name)
    )


def lost_warning(motion: SourceMotion, mapping: Mapping[str, str]) -> str | None:
    """What is to be said of joints that move nothing; None where all do."""
    lost = lost_joints(motion, mapping)
    if not lost:
        return None
    named = ", ".join(name[:60] for name in lost[:MAX_JOINTS_TOLD]) + (", ..." if len(lost) > MAX_JOINTS_TOLD else "")
    return f"{len(lost)} of the motion's joints move nothing of the character: {named}. Say by motion_joints what they move."


def not_humanoid(motion: SourceMotion, mapping: Mapping[str, str], detail: str) -> InputError:
    """The error for a skeleton that is nobody's as it is mapped."""
    found = {"mapping": dict(mapping), "joints": list(motion.names)}
    return InputError("motion_not_humanoid", detail, ("motion_joints", "motion"), found)


def _each_its_own(motion: SourceMotion, mapping: Mapping[str, str]) -> None:
    """Limbs between one joint and itself have no length and no direction."""
    moved: dict[str, list[str]] = {}
    for name in REQUIRED_MOTION_JOINTS:
        moved.setdefault(mapping[name], []).append(name)
    for joint, names in moved.items():
        if len(names) > 1:
            detail = f"The motion's joint {joint!r} cannot move all of {', '.join(names)}: say which others do."
            raise not_humanoid(motion, mapping, detail)


def _check(motion: SourceMotion, overrides: Mapping[str, str | None]) -> None:
    for name, joint in overrides.items():
        if name not in TARGET_NAMES or (joint is not None and joint not in motion.names):
            what = name if name not in TARGET_NAMES else joint
            raise InputError(
                "motion_joint_unknown",
                f"There is no joint {what!r}: choose among those that are listed.",
                ("motion_joints",),
                {"joints": list(motion.names), "ours": list(TARGET_NAMES)},
            )


def _order_holds(parents: NDArray[np.int32], found: dict[str, int]) -> dict[str, int]:
    """Without the joints that do not hang below the joint that they ought to hang below."""
    kept = dict(found)
    for chain in JOINT_CHAINS:
        present = [name for name in chain if name in kept]
        for above, below in itertools.pairwise(present):
            if above in kept and not path(parents, kept[above], kept[below]):
                kept.pop(below)
    return kept


def _by_shape(motion: SourceMotion) -> dict[str, int]:
    """Bone lengths and places come from the frame in the middle: some files' rest pose has none that mean anything."""
    places = motion.world()[1][len(motion.rotations) // 2]
    parents = np.maximum(motion.parents, 0)
    lengths = np.linalg.norm(places - places[parents], axis=1)
    return match_shape(motion.parents, lengths, places)


def _trunk(parents: NDArray[np.int32], found: dict[str, int]) -> dict[str, int]:
    """Hips, spine, shoulders and neck, from where the limbs hang."""
    if any(name not in found for name in REQUIRED_MOTION_JOINTS[1:]):
        return found
    found = dict(found)
    hips = common_ancestor(parents, found["LeftUpLeg"], found["RightUpLeg"])
    chest = common_ancestor(parents, found["LeftArm"], found["RightArm"])
    trunk = common_ancestor(parents, hips, chest)
    if hips < 0 or chest < 0 or trunk < 0:
        return found
    if "Hips" not in found or not path(parents, found["Hips"], found["LeftUpLeg"]):
        found["Hips"] = hips
    spine = path(parents, trunk, chest)[1:]
    if spine:
        found["Spine2"] = spine[-1]
    if len(spine) >= 2:
        found["Spine"] = spine[0]
    if len(spine) >= 3:
        found["Spine1"] = spine[len(spine) // 2]
    for side in SIDE_NAMES:
        between = path(parents, chest, found[f"{side}Arm"])[1:-1]
        if f"{side}Shoulder" not in found and between:
            found[f"{side}Shoulder"] = between[-1]
    head = found.get("Head", -1)
    if head >= 0 and (neck := path(parents, chest, head)[1:-1]):
        found["Neck"] = neck[-1]
    elif head < 0 and "Neck" in found and (above := children_of(parents)[found["Neck"]]):
        found["Head"] = above[0]
    return found
