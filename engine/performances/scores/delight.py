"""Happiness and surprise.

The action units (P. Ekman, W. Friesen, Facial Action Coding System, 1978): happiness 6 + 12, with 25 where the teeth
show; surprise 1 + 2 + 5 + 26.
"""

from __future__ import annotations

import math

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.performances.catalogue import performance
from engine.performances.modelling.figure import Pose
from engine.performances.scores.acting import Units, add, head_sway, lids, pose, sum_turns
from engine.performances.scores.timing import blink, ease, glances, idle_noise, swell


def happy(t: float) -> Pose:
    """A smile that reaches the eyes: brows lift a little, cheeks follow, the lips part, a breath of laughter."""
    period = performance("happy").seconds
    calm = ease(t, 0.0, 0.3) * (1 - ease(t, period - 0.35, period - 0.03))
    units: Units = {}
    # two waves: a closed smile, then, out of it, the broad one that shows the teeth
    first = swell(t, 0.30, 0.92, 2.75, 3.62, sag=0.14)
    second = swell(t, 0.78, 1.38, 2.35, 3.20, sag=0.20)
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.035, 0.93)):
        corners = more * swell(t - lag, 0.30, 0.92, 2.80, 3.68, sag=0.12)
        broad = more * swell(t - lag, 0.78, 1.38, 2.35, 3.25, sag=0.20)
        cheeks = more * swell(t - lag, 0.36, 1.12, 2.55, 3.50, sag=0.18)
        # zygomaticus major draws the corners up and out, risorius (stretch) and buccinator (dimple) help
        add(units, f"mouthSmile{side}", 0.62 * corners + 0.36 * broad)
        add(units, f"mouthStretch{side}", 0.10 * corners + 0.22 * broad)
        add(units, f"mouthDimple{side}", 0.14 * corners)
        # the upper lip is lifted off the teeth, the lower one drawn down a little
        add(units, f"mouthUpperUp{side}", 0.10 * corners + 0.44 * broad)
        add(units, f"mouthLowerDown{side}", 0.22 * broad)
        # what makes it felt: orbicularis oculi raises the cheeks and narrows the eyes, a little later than the mouth
        add(units, f"cheekSquint{side}", 0.46 * cheeks + 0.40 * broad)
        add(units, f"eyeSquint{side}", 0.12 * cheeks + 0.18 * broad)
        add(units, f"noseSneer{side}", 0.10 * broad)
        # a flash of the brows comes before the smile and is gone when it is full
        add(units, f"browOuterUp{side}", 0.22 * more * swell(t, 0.22, 0.62, 1.0, 2.2))
    laugh = swell(t, 1.05, 1.35, 1.75, 2.35)
    shake = laugh * laughter(t - 1.05)
    add(units, "jawOpen", 0.04 * first + 0.19 * second + 0.035 * shake)
    add(units, "browInnerUp", 0.12 * swell(t, 0.20, 0.58, 0.95, 2.0))
    lids(units, blink(t, 0.36, depth=0.96) + blink(t, 2.86), lead=0.03, squint=0.5 * second)
    head = (
        -2.6 * swell(t, 0.34, 1.10, 2.2, 3.4) + 1.1 * swell(t, 0.18, 0.42, 0.5, 0.85) + 0.55 * shake,
        1.6 * swell(t, 0.5, 1.4, 2.4, 3.6) + 0.5 * calm * idle_noise(t, 62, period, 4),
        2.7 * swell(t, 0.45, 1.30, 2.5, 3.7) + 0.3 * calm * idle_noise(t, 63, period, 3),
    )
    gaze = glances(t, ((-1, 0, 0), (0.40, 0.5, -0.8), (2.05, -0.4, 1.4), (2.9, 0, 0)))
    breath = 0.55 * swell(t, 0.15, 0.9, 1.0, 2.2) - 0.12 * shake
    return pose(units, head, gaze, breath, (0.0, 0.0006 * shake, 0.003 * swell(t, 0.5, 1.3, 2.3, 3.6)))


def surprise(t: float) -> Pose:
    """A start: the eyes widen and the brows fly up, then the jaw drops and the head draws back; it ebbs away."""
    period = performance("surprise").seconds
    calm = ease(t, 0.0, 0.3) * (1 - ease(t, period - 0.4, period - 0.03))
    units: Units = {}
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.02, 0.95)):
        # frontalis: both brows, the whole forehead; it holds longest
        add(units, f"browOuterUp{side}", 1.2 * more * swell(t - lag, 0.34, 0.66, 1.62, 2.75, sag=0.18))
        # levator palpebrae: the lids are first to open and first to tire
        add(units, f"eyeWide{side}", 0.85 * more * swell(t - lag, 0.31, 0.52, 1.45, 2.25, sag=0.25))
        add(units, f"mouthUpperUp{side}", 0.10 * swell(t, 0.46, 0.84, 1.5, 2.2))
        add(units, f"mouthLowerDown{side}", 0.08 * swell(t, 0.46, 0.84, 1.5, 2.2))
    add(units, "browInnerUp", 1.15 * swell(t, 0.35, 0.68, 1.58, 2.70, sag=0.20))
    # the jaw drops, slack: lips rounded a little, not stretched
    jaw = swell(t, 0.42, 0.86, 1.42, 2.28, sag=0.16)
    add(units, "jawOpen", 0.52 * jaw)
    add(units, "mouthFunnel", 0.30 * swell(t, 0.46, 0.95, 1.5, 2.35))
    # closing, the lips press together for a moment before they settle
    add(units, "mouthShrugUpper", 0.05 * swell(t, 2.0, 2.4, 2.45, 2.9))
    for side in SIDE_NAMES:
        add(units, f"mouthPress{side}", 0.16 * swell(t, 2.05, 2.42, 2.50, 3.05))
    lids(units, blink(t, 0.20, depth=0.55, slow=0.8) + blink(t, 1.74), lead=0.0)
    # a tiny dip, then the head goes back and up
    start = swell(t, 0.36, 0.72, 1.35, 2.8, sag=0.25)
    head = (
        -3.4 * start + 0.9 * swell(t, 0.26, 0.40, 0.44, 0.7) + 0.3 * calm * idle_noise(t, 71, period, 4),
        -1.2 * swell(t, 0.5, 1.0, 1.6, 2.9) + 0.4 * calm * idle_noise(t, 72, period, 4),
        -1.1 * swell(t, 0.45, 0.95, 1.6, 2.9) + 0.2 * calm * idle_noise(t, 73, period, 3),
    )
    gaze = glances(t, ((-1, 0, 0), (0.30, 0.6, 0.3), (1.02, 0.2, -1.2), (1.36, 0.5, 1.0), (1.78, 0, 0)))
    breath = 0.9 * swell(t, 0.40, 0.80, 1.35, 2.9)
    return pose(units, head, gaze, breath, (0.0, 0.0025 * start, -0.007 * start))


def happy_strong(t: float) -> Pose:
    """Laughter: the broad smile at once, the mouth open, the eyes nearly shut, the head thrown back and shaking."""
    period = performance("happy-strong").seconds
    units: Units = {}
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.03, 0.94)):
        smile = more * swell(t - lag, 0.22, 0.70, 2.25, 3.10, sag=0.12)
        laugh = more * swell(t - lag, 0.46, 0.95, 1.85, 2.70, sag=0.22)
        add(units, f"mouthSmile{side}", 0.70 * smile + 0.38 * laugh)
        add(units, f"mouthStretch{side}", 0.10 * smile + 0.18 * laugh)
        add(units, f"mouthDimple{side}", 0.12 * smile)
        add(units, f"mouthUpperUp{side}", 0.10 * smile + 0.52 * laugh)
        add(units, f"mouthLowerDown{side}", 0.34 * laugh)
        add(units, f"cheekSquint{side}", 0.55 * smile + 0.50 * laugh)
        add(units, f"eyeSquint{side}", 0.16 * smile + 0.38 * laugh)
        add(units, f"noseSneer{side}", 0.16 * laugh)
        add(units, f"browOuterUp{side}", 0.26 * more * swell(t, 0.16, 0.50, 0.8, 1.7))
    laugh = swell(t, 0.50, 1.00, 1.80, 2.70, sag=0.2)
    shake = swell(t, 0.70, 0.95, 1.65, 2.25) * laughter(t - 0.70)
    add(units, "jawOpen", 0.05 * swell(t, 0.22, 0.7, 2.2, 3.0) + 0.38 * laugh + 0.05 * shake)
    add(units, "browInnerUp", 0.12 * swell(t, 0.16, 0.5, 0.8, 1.7))
    lids(units, blink(t, 0.24, depth=0.96) + blink(t, 2.46), lead=0.03, squint=0.5 * laugh)
    head = sum_turns(
        (-5.0 * swell(t, 0.42, 1.05, 1.7, 2.95) + 1.2 * swell(t, 0.12, 0.34, 0.42, 0.72) + 0.9 * shake, 0.0, 0.0),
        (0.0, -2.6 * swell(t, 0.45, 1.2, 1.8, 3.0), -3.4 * swell(t, 0.4, 1.15, 1.9, 3.05)),
        head_sway(t, 162, period, 0.5),
    )
    gaze = glances(t, ((-1, 0, 0), (0.30, 0.4, 0.8), (1.75, -0.4, -1.2), (2.5, 0, 0)))
    breath = 0.8 * swell(t, 0.1, 0.6, 0.8, 1.9) - 0.2 * shake
    return pose(units, head, gaze, breath, (0.0, 0.001 * shake, -0.003 * swell(t, 0.42, 1.0, 1.7, 2.95)))


def surprise_strong(t: float) -> Pose:
    """Astonishment: all of surprise, further and faster; the mouth stays open while it is taken in."""
    period = performance("surprise-strong").seconds
    units: Units = {}
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.02, 0.96)):
        add(units, f"browOuterUp{side}", 1.25 * more * swell(t - lag, 0.26, 0.54, 1.75, 2.75, sag=0.10))
        add(units, f"eyeWide{side}", 1.2 * more * swell(t - lag, 0.24, 0.44, 1.60, 2.40, sag=0.18))
        add(units, f"mouthUpperUp{side}", 0.12 * swell(t, 0.36, 0.72, 1.7, 2.3))
        add(units, f"mouthLowerDown{side}", 0.16 * swell(t, 0.36, 0.72, 1.7, 2.3))
        add(units, f"mouthPress{side}", 0.14 * swell(t, 2.12, 2.45, 2.50, 2.92))
    add(units, "browInnerUp", 1.25 * swell(t, 0.26, 0.56, 1.72, 2.75, sag=0.12))
    add(units, "jawOpen", 0.78 * swell(t, 0.32, 0.76, 1.62, 2.45, sag=0.10))
    add(units, "mouthFunnel", 0.32 * swell(t, 0.36, 0.80, 1.65, 2.45))
    lids(units, blink(t, 0.14, depth=0.55, slow=0.8) + blink(t, 1.92), lead=0.0)
    start = swell(t, 0.28, 0.62, 1.55, 2.75, sag=0.2)
    head = sum_turns(
        (-5.2 * start + 1.2 * swell(t, 0.18, 0.32, 0.36, 0.6), 1.8 * start, 1.6 * start),
        head_sway(t, 171, period, 0.4),
    )
    gaze = glances(t, ((-1, 0, 0), (0.22, 0.6, 0.3), (1.10, 0.2, 1.4), (1.50, 0.5, -1.0), (1.96, 0, 0)))
    return pose(units, head, gaze, swell(t, 0.3, 0.65, 1.5, 2.75), (0.0, 0.003 * start, -0.012 * start))


def laughter(t: float) -> float:
    """The shaking of silent laughter, five pulses a second that die away."""
    return math.sin(2 * math.pi * 4.6 * max(t, 0.0)) * math.exp(-0.9 * max(t, 0.0))
