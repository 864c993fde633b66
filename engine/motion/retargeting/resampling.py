"""Motions at another frame rate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.files.source_motion import SourceMotion

Array = NDArray[np.float64]

MIN_LOOP_FRAMES = 8
"""Frames of a loop, at least: it plays slower then."""


def loop_step(clip: Clip) -> Array:
    """(3,) from the last frame of a loop to the frame that would follow, as far as the ground plane goes: the mean of
    the steps beside it; upwards, exactly back to the first frame's height."""
    root = np.asarray(clip.root, np.float64)
    if len(root) == 1:
        return np.zeros(3)
    step = (root[1] - root[0] + root[-1] - root[-2]) / 2
    step[1] = root[0, 1] - root[-1, 1]
    return np.asarray(step)


def resample_source(motion: SourceMotion, fps: float) -> SourceMotion:
    """The same source motion at `fps` frames a second, or as it is if that is its own rate; a loop's length is rounded
    to whole frames."""
    frames = len(motion.rotations)
    if frames == 1 or abs(fps - motion.fps) < 1e-6 * fps:
        return motion
    if motion.loops:
        times = np.linspace(0, frames - 1, max(round((frames - 1) / motion.fps * fps), MIN_LOOP_FRAMES) + 1)
    else:
        times = _times(frames, motion.fps, fps)
    return replace(
        motion,
        fps=float(fps),
        rotations=turns_at(motion.rotations, times),
        translations=places_at(motion.translations, times),
    )


def turns_at(turns: Array, times: Array) -> Array:
    """Turns (F, ..., 4) at fractional frames `times` (N,)."""
    first = np.clip(np.floor(times).astype(int), 0, max(len(turns) - 2, 0))
    second = np.minimum(first + 1, len(turns) - 1)
    share = (times - first).reshape(-1, *[1] * (turns.ndim - 2))
    return rotation.slerp(turns[first], turns[second], share)


def places_at(places: Array, times: Array) -> Array:
    """Places (F, ..., 3) at fractional frames `times` (N,)."""
    first = np.clip(np.floor(times).astype(int), 0, max(len(places) - 2, 0))
    second = np.minimum(first + 1, len(places) - 1)
    share = (times - first).reshape(-1, *[1] * (places.ndim - 1))
    return np.asarray(places[first] * (1 - share) + places[second] * share)


def _times(frames: int, fps: float, wanted: float) -> Array:
    """Where the new frames lie among the old ones; the last one at or before the old end."""
    count = int(np.floor((frames - 1) / fps * wanted + 1e-6)) + 1
    return np.minimum(np.arange(count) * (fps / wanted), frames - 1.0)
