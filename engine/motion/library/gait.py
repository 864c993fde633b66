"""Walk and run.

Angles and their times over the gait cycle follow Winter, "Biomechanics and motor control of human movement" (2009),
chapters 3 and 4. For the run they follow Novacheck, "The biomechanics of running" (1998). The cycle begins when the
left foot touches the ground. A standing foot has one place on the ground and rolls over it; between, it goes to the
next.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.curves import Keys, ease, hermite_curve, periodic_curve
from engine.motion.library.posture import Arm, Foot, Posture, embody

Array = NDArray[np.float64]

WALK_SECONDS = 1.1
"""Seconds of a walk's cycle."""
WALK_STRIDE = 1.5
"""Leg lengths of way in a walk's cycle."""
WALK_STANCE_SHARE = 0.62
"""Share of a walk's cycle in which a foot stands."""

WALK_PITCH: Keys = (
    *((0.0, -20.0), (0.07, -3.0), (0.1, 0.0), (0.33, 0.0), (0.42, 8.0), (0.52, 26.0), (0.62, 50.0), (0.66, 56.0)),
    *((0.75, 36.0), (0.85, 2.0), (0.94, -18.0)),
)
WALK_LIFT: Keys = ((0.0, 0.0), (0.62, 0.0), (0.68, 0.035), (0.76, 0.065), (0.84, 0.04), (0.93, 0.03))

RUN_SECONDS = 0.7
"""Seconds of a run's cycle."""
RUN_STRIDE = 2.6
"""Leg lengths of way in a run's cycle."""
RUN_STANCE_SHARE = 0.3
"""Share of a run's cycle in which a foot stands."""
RUN_HEIGHT = -0.075
"""Leg lengths above standing at which the hips are as the feet leave the ground and touch it."""
RUN_RISE = 0.03
"""Leg lengths by which the hips rise in the air: gravity's way up and down in a fifth of the cycle."""

RUN_PITCH: Keys = (
    *((0.0, -4.0), (0.04, 0.0), (0.14, 0.0), (0.19, 14.0), (0.26, 42.0), (0.31, 62.0), (0.44, 82.0), (0.58, 66.0)),
    *((0.76, 20.0), (0.9, -4.0)),
)
RUN_LIFT: Keys = (
    (0.0, 0.0),
    (0.3, 0.0),
    (0.37, 0.1),
    (0.47, 0.28),
    (0.56, 0.36),
    (0.68, 0.3),
    (0.82, 0.14),
    (0.93, 0.04),
)


def walk(skeleton: Skeleton, fps: float) -> Clip:
    """A walk at an easy pace, about 1.15 m/s for a grown-up; loops, and travels along +z."""
    frames = max(round(WALK_SECONDS * fps), 8)
    phase = np.arange(frames) / frames
    turn = 2 * np.pi * phase
    sway = np.cos(turn - 2 * np.pi * 0.3)
    posture = Posture(
        frames=frames,
        root=(
            0.022 * sway,
            periodic_curve(phase * 2, ((0.0, -0.046), (0.12, -0.054), (0.6, -0.008))),
            WALK_STRIDE * phase + 0.008 * np.sin(2 * turn),
        ),
        hips=(2.0 + 1.0 * np.sin(2 * turn), -6.0 * np.cos(turn), 4.5 * np.sin(turn + 0.4)),
        spine=(1.5 - 1.0 * np.sin(2 * turn), 13.0 * np.cos(turn - 0.15), -6.0 * np.sin(turn + 0.4)),
        head=(1.0 + 1.5 * np.cos(2 * turn), 1.0 * np.cos(turn), -0.8 * np.sin(turn)),
        arms={"Left": _walking_arm(phase + 0.5), "Right": _walking_arm(phase)},
        feet={
            "Left": _going_foot(phase, WALK_STANCE_SHARE, WALK_STRIDE, -0.1, WALK_PITCH, WALK_LIFT, aside=-0.025),
            "Right": _going_foot(
                phase + 0.5, WALK_STANCE_SHARE, WALK_STRIDE, -0.1, WALK_PITCH, WALK_LIFT, aside=0.025, late=True
            ),
        },
    )
    return embody(posture, skeleton, "walk", fps, loops=True)


def run(skeleton: Skeleton, fps: float) -> Clip:
    """A run at about 3.1 m/s for a grown-up, both feet in the air between steps; loops, and travels along +z."""
    frames = max(round(RUN_SECONDS * fps), 8)
    phase = np.arange(frames) / frames
    turn = 2 * np.pi * phase
    posture = Posture(
        frames=frames,
        root=(
            0.012 * np.cos(turn - 2 * np.pi * 0.15),
            _running_height(phase),
            RUN_STRIDE * phase + 0.01 * np.sin(2 * turn - 0.6),
        ),
        hips=(7.0 + 2.0 * np.cos(2 * turn - 1.8), -9.0 * np.cos(turn - 0.2), 4.0 * np.sin(turn + 0.5)),
        spine=(5.0, 22.0 * np.cos(turn - 0.3), -5.0 * np.sin(turn + 0.5)),
        head=(4.0 + 2.0 * np.cos(2 * turn), 2.0 * np.cos(turn), 0.0),
        arms={"Left": _running_arm(phase + 0.5), "Right": _running_arm(phase)},
        feet={
            "Left": _going_foot(phase, RUN_STANCE_SHARE, RUN_STRIDE, -0.22, RUN_PITCH, RUN_LIFT, aside=-0.05),
            "Right": _going_foot(
                phase + 0.5, RUN_STANCE_SHARE, RUN_STRIDE, -0.22, RUN_PITCH, RUN_LIFT, aside=0.05, late=True
            ),
        },
    )
    return embody(posture, skeleton, "run", fps, loops=True)


def _running_height(phase: Array) -> Array:
    """The hips fall freely while both feet are in the air, and are caught and thrown up again in between."""
    half, landed = (phase * 2) % 1.0, 2 * RUN_STANCE_SHARE
    flight = np.clip((half - landed) / (1 - landed), 0, 1)
    speed = 4 * RUN_RISE / (1 - landed)
    caught = ((0.0, 0.0, -speed), (landed / 2, -speed * landed / 4, 0.0), (landed, 0.0, speed))
    return RUN_HEIGHT + np.where(half < landed, hermite_curve(half, caught), 4 * RUN_RISE * flight * (1 - flight))


def _going_foot(
    phase: Array, stance: float, stride: float, ahead: float, pitch: Keys, lift: Keys, aside: float, late: bool = False
) -> Foot:
    """A foot that stands from phase 0 to `stance`, and goes on by `stride` until the cycle ends.

    `ahead`: where the foot is in the middle of standing, as seen from the hips. `late`: this foot's cycle began half a
    cycle before the clip.
    """
    rounds = np.floor(phase) - (0.5 if late else 0.0)
    own = phase - np.floor(phase)
    gone = ease_foot((own - stance) / (1 - stance))
    # over the middle of standing the hips are at stride * stance / 2 from where they were as the foot touched
    place = stride * (rounds + gone + stance / 2) + ahead * stance
    return Foot(aside=aside, up=periodic_curve(own, lift), ahead=place, pitch=periodic_curve(own, pitch), yaw=7.0)


def ease_foot(share: Array) -> Array:
    """How far a foot is on its way: it starts gently and touches down almost at rest."""
    u = np.clip(share, 0, 1)
    return np.asarray(0.6 * u * u * (3 - 2 * u) + 0.4 * ease(u))


def _walking_arm(phase: Array) -> Arm:
    """Farthest forward at phase 0, as the other side's foot touches the ground."""
    forward = np.cos(2 * np.pi * (phase - 0.03))
    late = np.cos(2 * np.pi * (phase - 0.09))
    return Arm(
        swing=1.0 + 21.0 * forward,
        lift=9.0 - 1.5 * forward,
        twist=-10.0,
        elbow=20.0 + 13.0 * late,
        palm=-8.0,
        curl=22.0,
    )


def _running_arm(phase: Array) -> Arm:
    forward = np.cos(2 * np.pi * (phase - 0.04))
    return Arm(
        swing=-6.0 + 38.0 * forward,
        lift=16.0 - 5.0 * forward,
        twist=-24.0 - 8 * forward,
        elbow=88.0 + 14.0 * forward,
        curl=45.0,
        shrug=3.0,
    )


GAITS: dict[str, Callable[[Skeleton, float], Clip]] = {"walk": walk, "run": run}
