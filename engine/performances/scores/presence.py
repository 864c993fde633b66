"""Presence: what a face does that does nothing."""

from __future__ import annotations

import math

from engine.performances.catalogue import performance
from engine.performances.modelling.figure import Pose
from engine.performances.scores.acting import Units, add, add_both_sides, lids, pose, sum_turns
from engine.performances.scores.timing import blink, glances, idle_noise, swell


def idle(t: float) -> Pose:
    """Five seconds of presence: one breath, two blinks, a few glances, a head that is never quite still.

    Everything is periodic: the last frame leads into the first.
    """
    period = performance("idle").seconds
    breath = 0.5 - 0.5 * breathing(t / period)
    units: Units = {}
    lids(units, blink(t, 1.27) + 0.94 * blink(t, 3.63, slow=1.15), lead=0.02)
    # tone in the muscles at rest: corners of the mouth, lips and brows wander by a few hundredths
    settle = 0.5 + 0.5 * idle_noise(t, 41, period, 3) * 0.5
    for side, seed in (("Left", 42), ("Right", 43)):
        add(units, f"mouthSmile{side}", 0.022 * (idle_noise(t, seed, period, 3) + 0.4))
        add(units, f"browOuterUp{side}", 0.03 * idle_noise(t, seed + 4, period, 3))
        add(units, f"mouthPress{side}", 0.05 * (settle - 0.5) ** 2)
    add(units, "browInnerUp", 0.035 * idle_noise(t, 48, period, 3))
    gaze = glances(
        t, ((-1, 0, 0), (0.86, -0.6, 2.2), (1.31, 0.3, -0.5), (2.48, -1.1, -2.8), (3.16, 0.2, -1.6), (3.67, 0, 0))
    )
    head = (
        0.75 * idle_noise(t, 51, period, 4) - 0.35 * breath,
        1.05 * idle_noise(t, 52, period, 4),
        0.50 * idle_noise(t, 53, period, 3),
    )
    lean = (0.0011 * idle_noise(t, 54, period, 3), 0.0, 0.0014 * idle_noise(t, 55, period, 3))
    return pose(units, head, gaze, breath, lean)


def idle_strong(t: float) -> Pose:
    """Presence that takes part: the eyes go round, the brows answer, the head tilts, something like a smile passes.

    Everything is periodic: the last frame leads into the first.
    """
    period = performance("idle-strong").seconds
    breath = 0.5 - 0.5 * breathing(t / period)
    units: Units = {}
    lids(units, blink(t, 0.92) + 0.95 * blink(t, 2.66, slow=1.1), lead=0.02)
    interest = swell(t, 0.95, 1.45, 1.75, 2.55, sag=0.2)
    warmth = swell(t, 1.7, 2.3, 2.7, 3.7, sag=0.15)
    add_both_sides(units, "browOuterUp", 0.34 * interest)
    add(units, "browInnerUp", 0.26 * interest + 0.05 * idle_noise(t, 148, period, 3))
    add_both_sides(units, "mouthSmile", 0.30 * warmth + 0.02 * idle_noise(t, 142, period, 3), right=0.86)
    add_both_sides(units, "cheekSquint", 0.16 * warmth)
    add_both_sides(units, "mouthPress", 0.14 * swell(t, 0.35, 0.7, 0.85, 1.3))
    gaze = glances(
        t, ((-1, 0, 0), (0.45, 1.0, 6.0), (0.98, 0.4, -1.5), (1.62, -1.0, -6.5), (2.30, 0.4, -2.0), (2.72, 0, 0))
    )
    head = sum_turns(
        (
            1.3 * idle_noise(t, 151, period, 4) - 0.5 * breath,
            1.6 * idle_noise(t, 152, period, 4),
            idle_noise(t, 153, period, 3),
        ),
        (-1.8 * interest, 3.2 * swell(t, 0.5, 1.0, 1.1, 1.7) - 4.0 * swell(t, 1.65, 2.2, 2.4, 3.3), 2.6 * warmth),
    )
    lean = (0.002 * idle_noise(t, 154, period, 3), 0.0, 0.002 * idle_noise(t, 155, period, 3))
    return pose(units, head, gaze, breath, lean)


def breathing(phase: float) -> float:
    """One breath, 1 at rest and -1 at its height: two fifths of the time in, three fifths out, no corners."""
    bent = phase + 0.06 * math.sin(2 * math.pi * phase)
    return math.cos(2 * math.pi * bent)
