"""Legs that follow where their feet are put."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from engine.motion import rotation
from engine.motion.feet.inverse_kinematics import two_bones
from engine.motion.feet.sole import Sole

Array = NDArray[np.float64]

MAX_STRETCH_SHARE = 0.998
"""The share of a leg's length to which a foot on the ground may stretch it."""

KNEE_AXIS = (1.0, 0.0, 0.0)
"""Knees bend about the axis to the left: a positive turn brings the shin back."""


@dataclass
class HeldFoot:
    """One foot over time.

    rotations : (F, 4) of the foot in the world.
    toes : (F, 4) of the toes in the world.
    ankle : (F, 3) where it is.
    held : (F,) how far the foot is held.
    """

    rotations: Array
    toes: Array
    ankle: Array
    held: Array


def set_legs(world: Array, places: Array, feet: Sequence[tuple[Sole, HeldFoot]]) -> None:
    """Turn legs, feet and toes in `world` (F, J, 4), whose joints are at `places` (F, J, 3), so that the ankles are where
    the feet want them."""
    for sole, foot in feet:
        hip, knee, ankle, toe = sole.joints
        limb = (places[:, hip], places[:, knee], places[:, ankle])
        world[:, hip], world[:, knee], _ = two_bones(limb, (world[:, hip], world[:, knee]), foot.ankle, KNEE_AXIS)
        world[:, ankle] = foot.rotations
        if toe >= 0:
            world[:, toe] = foot.toes


def ankle_over_ball(sole: Sole, rotations: Array, level: Array, pitch: Array) -> Array:
    """(F, 3) from where the ball lies, when the foot is flat, to the ankle of the rolling foot. `rotations` (F, 4) are
    the foot's in the world, `level` is its rotation if it lay flat, and `pitch` (F,) radians are between them."""
    over_ball = -sole.ball - rotation.rotate(rotations, sole.toe)
    over_heel = rotation.rotate(level, sole.heel - sole.toe - sole.ball) - rotation.rotate(rotations, sole.heel)
    return np.where(pitch[:, None] > 0, over_ball, over_heel)


def hip_lowering(feet: Sequence[tuple[Sole, HeldFoot]], places: Array, fps: float, loops: bool = False) -> Array:
    """(F,) metres by which the hips must go down for held feet to be in reach, smooth over time; `places` (F, J, 3) of
    the joints."""
    needed = np.zeros(len(places))
    for sole, foot in feet:
        hip, knee, ankle, _ = sole.joints
        length = np.linalg.norm(places[0, knee] - places[0, hip]) + np.linalg.norm(places[0, ankle] - places[0, knee])
        aside = np.linalg.norm((foot.ankle - places[:, hip])[:, [0, 2]], axis=1)
        height = np.sqrt(np.maximum((MAX_STRETCH_SHARE * length) ** 2 - aside**2, 0))
        down = places[:, hip, 1] - foot.ankle[:, 1] - height
        needed = np.maximum(needed, np.clip(down, 0, 0.2 * length) * foot.held)
    if not needed.any():
        return needed
    window = max(round(0.08 * fps), 1)
    mode: Literal["wrap", "nearest"] = "wrap" if loops else "nearest"
    widened = maximum_filter1d(needed, 2 * window + 1, mode=mode)
    return np.asarray(gaussian_filter1d(widened, window / 2, mode=mode))
