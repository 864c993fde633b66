"""Clips that stay on their feet: idle, wave, bow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.library.curves import curve_through, ease
from engine.motion.library.posture import Arm, Foot, Posture, embody

Array = NDArray[np.float64]

STANDING_FEET = {"Left": Foot(aside=0.02, yaw=9.0), "Right": Foot(aside=-0.02, yaw=9.0)}
"""How a person stands who waits: every clip that begins or ends standing, does so like this."""

HANGING_ARM = Arm(swing=2.0, lift=9.0, twist=-8.0, elbow=14.0, palm=-6.0, curl=20.0)


def idle(skeleton: Skeleton, fps: float) -> Clip:
    """Breathing, the weight going from one leg to the other, a look aside; loops."""
    frames = max(round(6.0 * fps), 8)
    phase = np.arange(frames) / frames
    turn = 2 * np.pi * phase
    breath, weight = np.sin(2 * turn), np.sin(turn)
    look = 7.0 * np.sin(turn - 0.8) + 3.0 * np.sin(2 * turn + 0.4)
    arms = {
        side: Arm(
            swing=2.0 + 1.2 * np.sin(turn + late),
            lift=9.0 + 0.8 * breath,
            twist=-8.0,
            elbow=14.0 + 1.5 * np.sin(2 * turn + late),
            palm=-6.0,
            shrug=1.0 * breath,
            curl=20.0 + 3.0 * np.sin(turn + late),
        )
        for side, late in (("Left", 0.0), ("Right", 1.1))
    }
    posture = Posture(
        frames=frames,
        root=(0.026 * weight, -0.006 - 0.005 * weight**2 + 0.002 * breath, 0.004 * np.sin(turn + 1.0)),
        hips=(0.5, 1.5 * weight, 1.8 * weight),
        spine=(0.8 - 1.3 * breath, -2.0 * weight, -2.6 * weight),
        head=(1.0 + 1.0 * np.sin(2 * turn + 1.5), look, 0.8 * np.sin(turn)),
        arms=arms,
        feet=STANDING_FEET,
    )
    return embody(posture, skeleton, "idle", fps, loops=True)


def wave(skeleton: Skeleton, fps: float) -> Clip:
    """The right hand goes up, waves three times and comes down; begins and ends standing."""
    frames = round(3.2 * fps) + 1
    time = np.arange(frames) / fps
    up = ease((time - 0.15) / 0.6) - ease((time - 2.45) / 0.65)
    early = ease((time - 0.1) / 0.5) - ease((time - 2.5) / 0.65)
    swings = np.sin(2 * np.pi * (time - 0.72) / 0.58) * (ease((time - 0.6) / 0.3) - ease((time - 2.3) / 0.3))
    arm = Arm(
        swing=2.0 + 22.0 * early,
        lift=9.0 + 66.0 * up,
        twist=-8.0 + 66.0 * up + 6 * swings,
        elbow=14.0 + 88.0 * early + 20.0 * swings * up,
        palm=-6.0 + 6.0 * up,
        wrist=-8.0 * swings,
        shrug=7.0 * up,
        curl=20.0 - 14.0 * up,
    )
    other = Arm(swing=2.0 - 2.0 * up, lift=9.0 + 2.0 * up, twist=-8.0, elbow=14.0 + 4.0 * up, palm=-6.0, curl=20.0)
    posture = Posture(
        frames=frames,
        root=(0.02 * up, -0.006 - 0.003 * up + 0.0 * time, 0.0),
        hips=(0.5, -2.0 * up, 2.0 * up),
        spine=(0.8, -2.0 * up, -5.0 * up + 0.8 * swings),
        head=(1.0 - 2.0 * up, 3.0 * up, -6.0 * up),
        arms={"Left": other, "Right": arm},
        feet=STANDING_FEET,
    )
    return embody(posture, skeleton, "wave", fps)


def bow(skeleton: Skeleton, fps: float) -> Clip:
    """A bow from the hips, held for a moment; begins and ends standing."""
    frames = round(3.0 * fps) + 1
    time = np.arange(frames) / fps
    down = curve_through(time, ((0.2, 0.0), (1.15, 1.0), (1.75, 1.0), (2.8, 0.0)))
    head = curve_through(time, ((0.1, 0.0), (1.0, 1.0), (1.85, 1.0), (2.9, 0.0)))
    arm = Arm(
        swing=2.0 + 26.0 * down,
        lift=9.0 - 2.0 * down,
        twist=-8.0 - 4.0 * down,
        elbow=14.0 + 6.0 * down,
        palm=-6.0,
        curl=20.0 - 8.0 * down,
    )
    posture = Posture(
        frames=frames,
        root=(0.0, -0.006 - 0.012 * down, -0.12 * down),
        hips=(0.5 + 32.0 * down, 0.0, 0.0),
        spine=(0.8 + 26.0 * down, 0.0, 0.0),
        head=(1.0 + 62.0 * head, 0.0, 0.0),
        arms={"Left": arm, "Right": arm},
        feet=STANDING_FEET,
    )
    return embody(posture, skeleton, "bow", fps)
