"""A jump on the spot."""

from __future__ import annotations

import numpy as np

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.curves import curve_through, hermite_curve
from engine.motion.library.posture import Arm, Foot, Posture, embody
from engine.motion.library.standing import STANDING_FEET

TAKE_OFF_SECONDS = 0.78
"""Seconds at which the feet leave the ground."""
LANDING_SECONDS = 1.2
"""Seconds at which the feet touch the ground again."""
END_SECONDS = 2.2
"""Seconds at which the clip ends."""

TAKE_OFF_LEG_LENGTHS_PER_SECOND = 2.4
"""Leg lengths a second at which the body leaves the ground: what gravity makes of the time in the air."""


def jump(skeleton: Skeleton, fps: float) -> Clip:
    """Crouch with the arms back, leap with the arms up, land softly; begins and ends standing."""
    frames = round(END_SECONDS * fps) + 1
    time = np.arange(frames) / fps
    flight = np.clip((time - TAKE_OFF_SECONDS) / (LANDING_SECONDS - TAKE_OFF_SECONDS), 0, 1)
    rise = TAKE_OFF_LEG_LENGTHS_PER_SECOND * (LANDING_SECONDS - TAKE_OFF_SECONDS) * flight * (1 - flight)
    height = hermite_curve(
        time,
        (
            *(
                (0.1, -0.006, 0.0),
                (0.52, -0.29, 0.0),
                (TAKE_OFF_SECONDS, 0.08, TAKE_OFF_LEG_LENGTHS_PER_SECOND),
                (LANDING_SECONDS, 0.03, -TAKE_OFF_LEG_LENGTHS_PER_SECOND),
            ),
            *((1.38, -0.23, 0.0), (1.95, -0.006, 0.0)),
        ),
    )
    height = np.where((time > TAKE_OFF_SECONDS) & (time < LANDING_SECONDS), rise + 0.08 - 0.05 * flight, height)
    lean = curve_through(time, ((0.1, 0.0), (0.5, 1.0), (0.76, -0.05), (1.1, 0.1), (1.36, 0.85), (1.95, 0.0)))
    arms = curve_through(
        time, ((0.05, 2.0), (0.42, -44.0), (0.86, 138.0), (1.0, 146.0), (1.3, 40.0), (1.55, 12.0), (2.0, 2.0))
    )
    bent = curve_through(time, ((0.05, 14.0), (0.45, 22.0), (0.62, 55.0), (0.86, 18.0), (1.25, 45.0), (2.0, 14.0)))
    arm = Arm(
        swing=arms,
        lift=curve_through(time, ((0.05, 9.0), (0.5, 14.0), (0.9, 16.0), (1.3, 26.0), (2.0, 9.0))),
        twist=-8.0,
        elbow=bent,
        palm=-6.0,
        shrug=curve_through(time, ((0.5, 0.0), (0.85, 10.0), (1.3, 0.0))),
        curl=20.0,
    )
    pitch = curve_through(
        time, ((0.55, 0.0), (0.68, 16.0), (TAKE_OFF_SECONDS, 52.0), (0.95, 42.0), (LANDING_SECONDS, 20.0), (1.27, 0.0))
    )
    feet = {
        side: Foot(aside=foot.aside, up=rise * 1.02, ahead=0.0, pitch=pitch, yaw=foot.yaw)
        for side, foot in STANDING_FEET.items()
    }
    posture = Posture(
        frames=frames,
        root=(0.0, height, -0.1 * lean + 0.035 * flight * (1 - flight) * 4),
        hips=(0.5 + 30.0 * lean, 0.0, 0.0),
        spine=(0.8 + 22.0 * lean, 0.0, 0.0),
        head=(1.0 + 8.0 * lean - 10.0 * flight * (1 - flight) * 4, 0.0, 0.0),
        arms={"Left": arm, "Right": arm},
        feet=feet,
    )
    return embody(posture, skeleton, "jump", fps)
