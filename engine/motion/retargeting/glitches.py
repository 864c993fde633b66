"""Faults of motion capture: joints that flip over from one frame to the next.

Solvers that fit skeletons to markers lose a stretched limb's twist, and find it again some frames later. No joint of a
person turns so fast.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.motion import rotation
from engine.motion.files.source_motion import SourceMotion

Array = NDArray[np.float64]

MIN_FLIP_ANGLE = np.radians(60)
"""A joint that turns by less from one frame to the next is not flipped."""

MAX_RADIANS_PER_SECOND = np.radians(3600)
"""Radians a second: people's joints stay under it, but for the inner rotation of a pitcher's arm."""

MAX_FLIP_SECONDS = 0.5
"""Seconds for which a joint may be flipped over and come back: then those frames are bridged."""

SPREAD_SECONDS = 0.06
"""Seconds before and after a flip that is not taken back, over which it is spread."""


def without_flips(motion: SourceMotion) -> SourceMotion:
    """The motion with flipped joints turned evenly from the frame before to the frame after; the same motion if none
    flips."""
    steps = rotation.angle(rotation.multiply(rotation.inverse(motion.rotations[:-1]), motion.rotations[1:]))
    flips = steps > max(MIN_FLIP_ANGLE, float(MAX_RADIANS_PER_SECOND / motion.fps))
    if not flips.any():
        return motion
    rotations = motion.rotations.copy()
    for joint in np.flatnonzero(flips.any(0)):
        for before, after in _bridges(rotations[:, joint], np.flatnonzero(flips[:, joint]), motion.fps):
            share = np.arange(1, after - before) / (after - before)
            rotations[before + 1 : after, joint] = rotation.slerp(
                rotations[before, joint], rotations[after, joint], share
            )
    return replace(motion, rotations=rotations)


def _bridges(rotations: Array, flips: NDArray[np.intp], fps: float) -> list[tuple[int, int]]:
    """Good frames before and after each stretch to be bridged; `flips` are the last frames before each flip."""
    bridges, place = [], 0
    while place < len(flips):
        flip = int(flips[place])
        back = int(flips[place + 1]) + 1 if place + 1 < len(flips) else -1
        if back > 0 and back - flip <= MAX_FLIP_SECONDS * fps and _apart(rotations[flip], rotations[back]) < np.pi / 2:
            bridges.append((flip, back))
            place += 2
        else:
            reach = max(round(SPREAD_SECONDS * fps), 1)
            bridges.append((max(flip - reach, 0), min(flip + 1 + reach, len(rotations) - 1)))
            place += 1
    return bridges


def _apart(first: Array, second: Array) -> float:
    return float(rotation.angle(rotation.multiply(rotation.inverse(first), second)))
