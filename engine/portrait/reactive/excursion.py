"""From rest and back: a performance made to begin and to end in the target at rest.

At rest all control points lie where the picture has them, so that any pose can be led there by shrinking its offsets.
What is drawn on the way is a true frame of the animation, as sharp as any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_motion import ControlMotion

STIR_SHARE = 0.05
"""A performance begins and ends where this share of its furthest offset is passed: what comes before is waiting."""
LEAD_FRAMES = 3
"""Frames kept before a performance begins, over which the face sets out from rest."""
SETTLE_SECONDS = 0.3
"""Seconds over which a performance comes to rest at its end; a looping one also sets out over as long."""


@dataclass(frozen=True)
class Pose:
    """What one frame shows: where the control points go, and the share [0, 1] of the driver's creases."""

    motion: ControlMotion
    creases: float = 1.0

    def eased(self, weight: float, rest: NDArray[np.float32]) -> Pose:
        """The pose on its way to rest, where `weight` is 0; `rest` (C,) is the control points' depth there."""
        w, motion = np.float32(weight), self.motion
        depth = rest + w * (motion.depth - rest)
        eased = ControlMotion(motion.frame, w * motion.offsets, depth, w * motion.look, w * motion.behind)
        return Pose(eased, weight * self.creases)


def excursion(motions: Sequence[ControlMotion], rest: NDArray[np.float32], fps: float, loops: bool) -> tuple[Pose, ...]:
    """A performance that sets out from rest in its first frame.

    One that loops is kept whole, and leads from its last frame back into the first. Of any other the waiting at both
    ends is left out, so that it answers at once, and its last frame is at rest too.
    """
    first, last = (0, len(motions) - 1) if loops else _stirring(motions)
    settle = max(2, round(SETTLE_SECONDS * fps))
    lead = settle if loops else LEAD_FRAMES
    count = last - first + 1
    index = np.arange(count)
    left = count - index if loops else count - 1 - index
    weight = smooth(index / lead) * smooth(left / settle)
    return tuple(Pose(motions[first + i]).eased(float(weight[i]), rest) for i in range(count))


def smooth(t: NDArray[np.floating]) -> NDArray[np.float64]:
    """From 0 at 0 to 1 at 1, at rest at both."""
    t = np.clip(t, 0, 1)
    return np.asarray(t * t * (3 - 2 * t), float)


def _stirring(motions: Sequence[ControlMotion]) -> tuple[int, int]:
    """The first and the last frame of what happens, with room to set out and to come back."""
    far = np.array([np.linalg.norm(motion.offsets, axis=1).max() for motion in motions])
    stirred = np.flatnonzero(far > STIR_SHARE * far.max())
    if not len(stirred):
        return 0, len(motions) - 1
    return max(0, int(stirred[0]) - LEAD_FRAMES), min(len(motions) - 1, int(stirred[-1]) + LEAD_FRAMES)
