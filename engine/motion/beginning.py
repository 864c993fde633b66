"""How much of a long motion is used: its beginning.

Recordings can last for hours, and what becomes of each second on the way to a character takes memory and time: what is
not used is cut off before all else. What is cut is no loop any more. What is not, is judged whole.
"""

from __future__ import annotations

from dataclasses import replace

from engine.motion.files.source_motion import SourceMotion

MAX_MOTION_SECONDS = 60.0
"""Seconds of a file's motion that are used, at most."""


def duration(motion: SourceMotion) -> float:
    """Seconds from the first frame to the last."""
    return max(len(motion.rotations) - 1, 0) / motion.fps


def beginning(motion: SourceMotion, seconds: float = MAX_MOTION_SECONDS) -> SourceMotion:
    """The frames of the first `seconds`; the same motion if it has no others."""
    frames = int(seconds * motion.fps + 1e-6) + 1
    if len(motion.rotations) <= frames:
        return motion
    return replace(motion, rotations=motion.rotations[:frames], translations=motion.translations[:frames], loops=False)


def length_warning(motion: SourceMotion) -> str | None:
    """What is to be said of a motion of which the beginning alone is used; None where all of it is."""
    if beginning(motion) is motion:
        return None
    lasts = duration(motion)
    return f"The motion lasts {lasts:.1f} s, of which the first {MAX_MOTION_SECONDS:.0f} are used: send the part that is meant."
