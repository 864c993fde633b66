"""What the actor does in each performance, second by second.

Every performance starts and ends in the same neutral pose (closed mouth, open eyes, looking into the camera), so
that one can be played after another. Weights of the face units (ARKit's names) are written as blends: what a
muscle group does together. The shapes were checked against real drivers: lip corners and brows rise in 0.3 to
0.6 s and fall more slowly; one side leads; the eyes answer before the mouth does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from engine.performances.catalogue import catalogue
from engine.performances.figure import Pose
from engine.performances.timing import blink, ease, glances, swell, unrest

Units = dict[str, float]


def idle(t: float) -> Pose:
    """Five seconds of presence: one breath, two blinks, a few glances, a head that is never quite still.

    Everything is periodic: the last frame leads into the first.
    """
    period = SECONDS["idle"]
    breath = 0.5 - 0.5 * _breathing(t / period)
    units: Units = {}
    _lids(units, blink(t, 1.27) + 0.94 * blink(t, 3.63, slow=1.15), lead=0.02)
    # tone in the muscles at rest: corners of the mouth, lips and brows wander by a few hundredths
    settle = 0.5 + 0.5 * unrest(t, 41, period, 3) * 0.5
    for side, seed in (("Left", 42), ("Right", 43)):
        _add(units, f"mouthSmile{side}", 0.022 * (unrest(t, seed, period, 3) + 0.4))
        _add(units, f"browOuterUp{side}", 0.03 * unrest(t, seed + 4, period, 3))
        _add(units, f"mouthPress{side}", 0.05 * (settle - 0.5) ** 2)
    _add(units, "browInnerUp", 0.035 * unrest(t, 48, period, 3))
    gaze = glances(
        t, ((-1, 0, 0), (0.86, -0.6, 2.2), (1.31, 0.3, -0.5), (2.48, -1.1, -2.8), (3.16, 0.2, -1.6), (3.67, 0, 0))
    )
    head = (
        0.75 * unrest(t, 51, period, 4) - 0.35 * breath,
        1.05 * unrest(t, 52, period, 4),
        0.50 * unrest(t, 53, period, 3),
    )
    lean = (0.0011 * unrest(t, 54, period, 3), 0.0, 0.0014 * unrest(t, 55, period, 3))
    return _pose(units, head, gaze, breath, lean)


def happy(t: float) -> Pose:
    """A smile that reaches the eyes: brows lift a little, cheeks follow, the lips part, a breath of laughter."""
    period = SECONDS["happy"]
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
        _add(units, f"mouthSmile{side}", 0.62 * corners + 0.36 * broad)
        _add(units, f"mouthStretch{side}", 0.10 * corners + 0.22 * broad)
        _add(units, f"mouthDimple{side}", 0.14 * corners)
        # the upper lip is lifted off the teeth, the lower one drawn down a little
        _add(units, f"mouthUpperUp{side}", 0.10 * corners + 0.44 * broad)
        _add(units, f"mouthLowerDown{side}", 0.22 * broad)
        # what makes it felt: orbicularis oculi raises the cheeks and narrows the eyes, a little later than the mouth
        _add(units, f"cheekSquint{side}", 0.46 * cheeks + 0.40 * broad)
        _add(units, f"eyeSquint{side}", 0.12 * cheeks + 0.18 * broad)
        _add(units, f"noseSneer{side}", 0.10 * broad)
        # a flash of the brows comes before the smile and is gone when it is full
        _add(units, f"browOuterUp{side}", 0.22 * more * swell(t, 0.22, 0.62, 1.0, 2.2))
    laugh = swell(t, 1.05, 1.35, 1.75, 2.35)
    shake = laugh * _laughter(t - 1.05)
    _add(units, "jawOpen", 0.04 * first + 0.19 * second + 0.035 * shake)
    _add(units, "browInnerUp", 0.12 * swell(t, 0.20, 0.58, 0.95, 2.0))
    _lids(units, blink(t, 0.36, depth=0.96) + blink(t, 2.86), lead=0.03, squint=0.5 * second)
    head = (
        -2.6 * swell(t, 0.34, 1.10, 2.2, 3.4) + 1.1 * swell(t, 0.18, 0.42, 0.5, 0.85) + 0.55 * shake,
        1.6 * swell(t, 0.5, 1.4, 2.4, 3.6) + 0.5 * calm * unrest(t, 62, period, 4),
        2.7 * swell(t, 0.45, 1.30, 2.5, 3.7) + 0.3 * calm * unrest(t, 63, period, 3),
    )
    gaze = glances(t, ((-1, 0, 0), (0.40, 0.5, -0.8), (2.05, -0.4, 1.4), (2.9, 0, 0)))
    breath = 0.55 * swell(t, 0.15, 0.9, 1.0, 2.2) - 0.12 * shake
    return _pose(units, head, gaze, breath, (0.0, 0.0006 * shake, 0.003 * swell(t, 0.5, 1.3, 2.3, 3.6)))


def surprise(t: float) -> Pose:
    """A start: the eyes widen and the brows fly up, then the jaw drops and the head draws back; it ebbs away."""
    period = SECONDS["surprise"]
    calm = ease(t, 0.0, 0.3) * (1 - ease(t, period - 0.4, period - 0.03))
    units: Units = {}
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.02, 0.95)):
        # frontalis: both brows, the whole forehead; it holds longest
        _add(units, f"browOuterUp{side}", 1.2 * more * swell(t - lag, 0.34, 0.66, 1.62, 2.75, sag=0.18))
        # levator palpebrae: the lids are first to open and first to tire
        _add(units, f"eyeWide{side}", 0.85 * more * swell(t - lag, 0.31, 0.52, 1.45, 2.25, sag=0.25))
        _add(units, f"mouthUpperUp{side}", 0.10 * swell(t, 0.46, 0.84, 1.5, 2.2))
        _add(units, f"mouthLowerDown{side}", 0.08 * swell(t, 0.46, 0.84, 1.5, 2.2))
    _add(units, "browInnerUp", 1.15 * swell(t, 0.35, 0.68, 1.58, 2.70, sag=0.20))
    # the jaw drops, slack: lips rounded a little, not stretched
    jaw = swell(t, 0.42, 0.86, 1.42, 2.28, sag=0.16)
    _add(units, "jawOpen", 0.52 * jaw)
    _add(units, "mouthFunnel", 0.30 * swell(t, 0.46, 0.95, 1.5, 2.35))
    # closing, the lips press together for a moment before they settle
    _add(units, "mouthShrugUpper", 0.05 * swell(t, 2.0, 2.4, 2.45, 2.9))
    for side in ("Left", "Right"):
        _add(units, f"mouthPress{side}", 0.16 * swell(t, 2.05, 2.42, 2.50, 3.05))
    _lids(units, blink(t, 0.20, depth=0.55, slow=0.8) + blink(t, 1.74), lead=0.0)
    # a tiny dip, then the head goes back and up
    start = swell(t, 0.36, 0.72, 1.35, 2.8, sag=0.25)
    head = (
        -3.4 * start + 0.9 * swell(t, 0.26, 0.40, 0.44, 0.7) + 0.3 * calm * unrest(t, 71, period, 4),
        -1.2 * swell(t, 0.5, 1.0, 1.6, 2.9) + 0.4 * calm * unrest(t, 72, period, 4),
        -1.1 * swell(t, 0.45, 0.95, 1.6, 2.9) + 0.2 * calm * unrest(t, 73, period, 3),
    )
    gaze = glances(t, ((-1, 0, 0), (0.30, 0.6, 0.3), (1.02, 0.2, -1.2), (1.36, 0.5, 1.0), (1.78, 0, 0)))
    breath = 0.9 * swell(t, 0.40, 0.80, 1.35, 2.9)
    return _pose(units, head, gaze, breath, (0.0, 0.0025 * start, -0.007 * start))


SECONDS: Mapping[str, float] = {performance.name: performance.seconds for performance in catalogue()}

SCORES: Mapping[str, Callable[[float], Pose]] = {"idle": idle, "happy": happy, "surprise": surprise}


def _pose(
    units: Units,
    head: tuple[float, float, float],
    gaze: tuple[float, float],
    breath: float,
    lean: tuple[float, float, float],
) -> Pose:
    """Let the lids follow the gaze, as they do, and the eyes hold their aim while the head turns."""
    up, left = gaze[0] + 0.9 * head[0], gaze[1] - 0.9 * head[1]
    for side in ("Left", "Right"):
        _add(units, f"eyeLookUp{side}", max(up, 0.0) / 30)
        _add(units, f"eyeLookDown{side}", max(-up, 0.0) / 30)
    return Pose(units=units, head=head, lean=lean, gaze=(up, left), breath=breath)


def _lids(units: Units, shut: float, lead: float, squint: float = 0.0) -> None:
    """Close both eyes; the left is ahead by a small share of the way, the lower lid comes up to meet the upper."""
    for side, share in (("Left", 1 + lead), ("Right", 1 - lead)):
        closed = min(max(shut * (1 if shut > 0.9 else share), 0.0), 1.0)
        _add(units, f"eyeBlink{side}", closed)
        _add(units, f"eyeSquint{side}", 0.12 * closed * (1 - squint))
        _add(units, f"browDown{side}", 0.035 * closed)


def _add(units: Units, name: str, weight: float) -> None:
    units[name] = units.get(name, 0.0) + weight


def _breathing(phase: float) -> float:
    """One breath, 1 at rest and -1 at its height: two fifths of the time in, three fifths out, no corners."""
    bent = phase + 0.06 * math.sin(2 * math.pi * phase)
    return math.cos(2 * math.pi * bent)


def _laughter(t: float) -> float:
    """The shaking of silent laughter, five pulses a second that die away."""
    return math.sin(2 * math.pi * 4.6 * max(t, 0.0)) * math.exp(-0.9 * max(t, 0.0))
