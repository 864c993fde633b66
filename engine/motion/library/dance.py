"""A dance: steps to the sides with a bounce on every beat, then arms up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.curves import ease, periodic_curve
from engine.motion.library.posture import Arm, Foot, Posture, Value, embody

Array = NDArray[np.float64]

BEAT_COUNT, DANCE_BEAT_SECONDS = 8, 0.5
STEP_WIDTH = 0.3
"""Leg lengths from side to side."""


def dance(skeleton: Skeleton, fps: float) -> Clip:
    """Eight beats at 120 a minute: step left, touch, step right, touch, twice, the second time with arms up; loops.

    Each foot goes aside on one beat and comes back on another; it stands still in between.
    """
    frames = max(round(BEAT_COUNT * DANCE_BEAT_SECONDS * fps), 8)
    beat = np.arange(frames) / frames * BEAT_COUNT
    bar = beat % 4
    left_at, left_up = _goes(bar, out=0.0, back=3.0)
    right_at, right_up = _goes(bar, out=2.0, back=1.0, out_first=False)
    side = np.sin(2 * np.pi * (bar - 0.1) / 4)
    bounce = np.cos(2 * np.pi * beat)
    up = periodic_curve(beat / BEAT_COUNT, ((0.0, 0.0), (0.44, 0.0), (0.56, 1.0), (0.88, 1.0)))
    groove = np.sin(2 * np.pi * beat / 2 - 0.5)
    posture = Posture(
        frames=frames,
        root=(0.5 * STEP_WIDTH * side, -0.06 - 0.028 * bounce, 0.012 * groove),
        hips=(2.0, 7.0 * np.sin(np.pi * beat - 0.4), 6.0 * np.sin(np.pi * bar / 2 + 0.5)),
        spine=(5.0 + 2.5 * bounce, -16.0 * np.sin(np.pi * beat - 0.7), -7.0 * np.sin(np.pi * bar / 2 + 0.3)),
        head=(3.0 + 5.0 * bounce, 9.0 * side, 5.0 * np.sin(np.pi * bar / 2 + 1.0)),
        arms={"Left": _arm(beat, up, 0.0), "Right": _arm(beat, up, 1.0)},
        feet={
            "Left": Foot(aside=STEP_WIDTH * left_at + 0.02, up=left_up, pitch=200.0 * left_up, yaw=12.0),
            "Right": Foot(aside=-STEP_WIDTH * right_at - 0.02, up=right_up, pitch=200.0 * right_up, yaw=12.0),
        },
    )
    return embody(posture, skeleton, "dance", fps, loops=True)


def _goes(bar: Array, out: float, back: float, out_first: bool = True) -> tuple[Array, Array]:
    """How far aside a foot is (0 to 1) and how high, over four beats: it sets off at beats `out` and `back`, and is
    there seven tenths of a beat later."""
    going, coming = np.clip((bar - out) / 0.7, 0, 1), np.clip((bar - back) / 0.7, 0, 1)
    away = ease(going) - ease(coming) if out_first else 1 - ease(coming) + ease(going)
    high = 0.1 * (np.sin(np.pi * going) ** 2 + np.sin(np.pi * coming) ** 2)
    return away, high


def _arm(beat: Array, up: Value, late: float) -> Arm:
    """Low, both fists pump in turn; up, the hands go from side to side over the head."""
    pump = np.sin(np.pi * (beat + late) - 0.3)
    low = 1 - np.asarray(up)
    return Arm(
        swing=low * (24.0 + 26.0 * pump) + up * (58.0 + 14.0 * pump),
        lift=low * (22.0 + 6.0 * pump) + up * (104.0 + 10.0 * pump),
        twist=low * -18.0 + up * 30.0,
        elbow=low * (88.0 + 18.0 * pump) + up * (62.0 - 20.0 * pump),
        palm=-10.0 * low,
        wrist=6.0 * pump,
        shrug=3.0 + 3.0 * pump + 9.0 * np.asarray(up),
        curl=34.0 * low + 16.0 * np.asarray(up),
    )
