"""What can be told of a motion before it moves anybody: its skeleton, and which of its joints move which of ours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.errors import InputError
from engine.motion.beginning import beginning, duration
from engine.motion.files.source_motion import SourceMotion
from engine.motion.retargeting.joint_map import REQUIRED_MOTION_JOINTS, map_joints
from engine.motion.retargeting.retarget import clean_motion


@dataclass(frozen=True)
class CheckedMotion:
    """What is in a motion.

    fps, frames, seconds : how long it plays.
    joints : the names of its joints.
    parents : the names of their parents, None for roots.
    mapping : `{our joint: its joint}`.
    loops : whether it is played on and on; None where that is not known, either.
    missing : our joints that must have one of its joints and have none.
    refused : says so then: the motion is of use only with overrides, if at all.
    """

    fps: float
    frames: int
    seconds: float
    joints: tuple[str, ...]
    parents: tuple[str | None, ...]
    mapping: Mapping[str, str]
    loops: bool | None = None
    missing: tuple[str, ...] = ()
    refused: InputError | None = None


def check_motion(motion: SourceMotion, overrides: Mapping[str, str | None] | None = None) -> CheckedMotion:
    """Look at a motion; `overrides` are as for `map_joints`.

    Raises
    ------
    InputError : `motion_joint_unknown`.
    """
    refused = loops = None
    try:
        mapping = map_joints(motion, overrides)
        loops = bool(clean_motion(beginning(motion), mapping)[0].loops)
    except InputError as error:
        if "mapping" not in error.found:
            raise
        mapping, refused = dict(error.found["mapping"]), error
    return CheckedMotion(
        fps=motion.fps,
        frames=len(motion.rotations),
        seconds=duration(motion),
        joints=motion.names,
        parents=tuple(motion.names[parent] if parent >= 0 else None for parent in motion.parents),
        mapping=mapping,
        loops=loops,
        missing=tuple(name for name in REQUIRED_MOTION_JOINTS if name not in mapping),
        refused=refused,
    )
