"""A motion as its file tells it: the skeleton it was made for, and that skeleton's frames."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.motion import kinematics, rotation

Array = NDArray[np.float64]

MAX_JOINTS = 512
"""Joints of a motion's skeleton."""

MAX_JOINT_DEPTH = 128
"""Joints from a skeleton's root down to its farthest leaf."""

MAX_MOTION_FRAMES = 72_000
"""Frames of a motion: ten minutes at 120 a second."""

MAX_MOTION_BYTES = 64 << 20
"""Bytes of a motion's file."""

MAX_NUMBERS = 8_000_000
"""Joints' channels times frames: what ten minutes of a skeleton with 37 joints at 120 frames a second need."""


@dataclass(frozen=True)
class SourceMotion:
    """F frames of a skeleton of any kind with J joints, lengths in the file's own unit.

    name : the motion's.
    fps : frames a second.
    names : of the joints.
    parents : (J,) int32, -1 for roots, parents before children.
    rest_rotations : (J, 4) quaternions of the pose that the file calls rest, in parents' axes; none turns in a BVH file.
    rest_offsets : (J, 3) places of the joints in that pose, in parents' axes.
    ends : (J, 3) where the bone of a joint without children ends, in the joint's axes; NaN where the file is silent.
    rotations : (F, J, 4) quaternions of the frames, in parents' axes.
    translations : (F, J, 3) places of the joints in the frames, in parents' axes.
    up : the world's axis that points up, or None where the format leaves it open.
    unit : the name of the file's unit; a guess for formats that do not tell.
    unit_metres : its length; a guess likewise.
    loops : whether the last frame shows the first again, moved on by what the root travels; None where the file is silent.
    skeletons : the first joints of all skeletons in the file, this one's first; empty where the format holds one alone.
    """

    name: str
    fps: float
    names: tuple[str, ...]
    parents: NDArray[np.int32]
    rest_rotations: Array
    rest_offsets: Array
    ends: Array
    rotations: Array
    translations: Array
    up: tuple[float, float, float] | None = None
    unit: str = "unknown"
    unit_metres: float = float("nan")
    loops: bool | None = None
    skeletons: tuple[str, ...] = ()

    def rest(self) -> tuple[Array, Array]:
        """World rotations (J, 4) and places (J, 3) of the rest pose."""
        return place(self.parents, self.rest_rotations, self.rest_offsets)

    def world(self) -> tuple[Array, Array]:
        """World rotations (F, J, 4) and places (F, J, 3) of the frames."""
        return place(self.parents, self.rotations, self.translations)


def place(parents: NDArray[np.int32], rotations: Array, offsets: Array) -> tuple[Array, Array]:
    """World rotations and places of joints, given in parents' axes; every root stands at its own offset."""
    world = kinematics.world_rotations(parents, rotations)
    places = np.array(offsets, np.float64)
    for joint, parent in enumerate(parents):
        if parent >= 0:
            turned = rotation.rotate(world[..., parent, :], places[..., joint, :])
            places[..., joint, :] = places[..., parent, :] + turned
    return world, places


def unique_names(names: Iterable[str]) -> tuple[str, ...]:
    """The names, cut at 128 letters, those that came before with a number behind them; what no text can hold (half a
    character) is a question mark."""
    seen: dict[str, int] = {}
    found = []
    for name in (name[:128].encode(errors="replace").decode() for name in names):
        said = name
        while said in seen:
            seen[name] += 1
            said = f"{name} #{seen[name]}"
        seen[said] = 1
        found.append(said)
    return tuple(found)
