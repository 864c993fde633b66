"""Motions that are loops: their last pose leads into their first.

Few files say so. It shows at the seam. Every joint goes on from the last frame into the first as it goes on anywhere
else, and the hips are as high again. Where they are over the ground does not matter. What begins and ends at rest, such
as a bow, comes back to its first pose, too, and is done once.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.motion import rotation
from engine.motion.files.source_motion import SourceMotion
from engine.motion.interpolation import places_at, rotations_at

Array = NDArray[np.float64]

MIN_MOTION_LOOP_FRAMES = 8
"""A motion of fewer frames is no loop."""

MAX_SEAM_ERROR = 0.3
"""By how much a joint may miss the first pose: of the usual step of the joint that is quickest."""

MAX_HEIGHT_ERROR = 0.02
"""Leg lengths by which the hips may miss their first height."""

MIN_SPEED_SHARE = 0.1
"""What is slower than this share of its usual speed is at rest."""

WHOLE_FRAME_TOLERANCE_FRAMES = 0.15
"""Frames: files either show the first pose again or leave that out; what is found between is noise, if less than this."""


def as_loop(motion: SourceMotion, heights: Array) -> SourceMotion:
    """The motion as a loop, if it leads into itself and its file does not say otherwise; else the same motion.
    `heights` (F,): of the hips, leg lengths."""
    if motion.loops is not None or len(motion.rotations) < MIN_MOTION_LOOP_FRAMES:
        return motion
    rotations, places = motion.rotations, motion.translations
    speeds = rotation.angle(_change(rotations[:-1], rotations[1:])).max(1)
    usual = float(np.median(speeds))
    first, last, gap = (rotation.to_vector(_change(rotations[a], rotations[b])) for a, b in ((0, 1), (-2, -1), (-1, 0)))
    pace, rise = (first + last) / 2, (heights[1] - heights[0] + heights[-1] - heights[-2]) / 2
    frames = float(np.sum(gap * pace) / max(np.sum(pace**2), 1e-12))
    missed = np.linalg.norm(gap - frames * pace, axis=-1).max()
    sunk = abs(heights[0] - heights[-1] - frames * rise)
    moves = usual > 0 and (speeds[0] + speeds[-1]) / 2 > MIN_SPEED_SHARE * usual
    if not moves or not -0.5 < frames < 1.5 or missed > MAX_SEAM_ERROR * usual or sunk > MAX_HEIGHT_ERROR:
        return motion
    if abs(frames - round(frames)) < WHOLE_FRAME_TOLERANCE_FRAMES:
        frames = round(frames)
    whole = len(rotations) - 1 + frames
    kept = min(int(np.ceil(whole)), len(rotations))
    beside = (places[1] - places[0] + places[-1] - places[-2]) / 2
    at = np.interp(np.linspace(0, whole, round(whole) + 1), [*range(kept), whole], range(kept + 1))
    return replace(
        motion,
        rotations=rotations_at(np.concatenate([rotations[:kept], rotations[:1]]), at),
        translations=places_at(np.concatenate([places[:kept], places[-1:] + frames * beside]), at),
        loops=True,
    )


def _change(before: Array, after: Array) -> Array:
    return rotation.multiply(rotation.inverse(before), after)
