"""Motions at another frame rate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.motion.files.source_motion import SourceMotion
from engine.motion.interpolation import places_at, rotations_at

Array = NDArray[np.float64]

MIN_RESAMPLED_LOOP_FRAMES = 8
"""Frames of a loop, at least: it plays slower then."""


def resample_source(motion: SourceMotion, fps: float) -> SourceMotion:
    """A source motion at `fps` frames a second, or as it is if that is its own rate; a loop's length is rounded to
    whole frames."""
    frames = len(motion.rotations)
    if frames == 1 or abs(fps - motion.fps) < 1e-6 * fps:
        return motion
    if motion.loops:
        times = np.linspace(0, frames - 1, max(round((frames - 1) / motion.fps * fps), MIN_RESAMPLED_LOOP_FRAMES) + 1)
    else:
        times = _times(frames, motion.fps, fps)
    return replace(
        motion,
        fps=float(fps),
        rotations=rotations_at(motion.rotations, times),
        translations=places_at(motion.translations, times),
    )


def _times(frames: int, fps: float, wanted: float) -> Array:
    """Where the new frames lie among the old ones; the last one at or before the old end."""
    count = int(np.floor((frames - 1) / fps * wanted + 1e-6)) + 1
    return np.minimum(np.arange(count) * (fps / wanted), frames - 1.0)
