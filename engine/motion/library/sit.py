"""Sitting down, on a seat as high as the knees."""

from __future__ import annotations

import numpy as np

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.curves import curve_through, ease
from engine.motion.library.posture import Arm, Foot, Posture, embody
from engine.motion.library.standing import STANDING_FEET


def sit(skeleton: Skeleton, fps: float) -> Clip:
    """Lean forward, sit down behind where the feet are, come upright, hands on the thighs; begins standing."""
    frames = round(3.0 * fps) + 1
    time = np.arange(frames) / fps
    down = ease((time - 0.25) / 1.35)
    lean = curve_through(time, ((0.1, 0.0), (0.95, 1.0), (1.5, 0.75), (2.3, 0.0)))
    arm = Arm(
        swing=2.0 + 22.0 * lean + 10.0 * down,
        lift=9.0 + 5.0 * lean + 2.0 * down,
        twist=-8.0,
        elbow=14.0 + 22.0 * down,
        palm=-6.0 - 20.0 * down,
        curl=20.0,
        rests=ease((time - 0.8) / 1.3),
    )
    posture = Posture(
        frames=frames,
        root=(0.0, -0.006 - 0.46 * down, -0.44 * down),
        hips=(0.5 + 26.0 * lean - 3.0 * down, 0.0, 0.0),
        spine=(0.8 + 16.0 * lean + 3.0 * down, 0.0, 0.0),
        head=(1.0 + 14.0 * lean, 0.0, 0.0),
        arms={"Left": arm, "Right": arm},
        feet={side: Foot(aside=foot.aside, yaw=foot.yaw) for side, foot in STANDING_FEET.items()},
    )
    return embody(posture, skeleton, "sit", fps)
