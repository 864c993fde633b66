"""Anger, fear and sadness.

The action units (P. Ekman, W. Friesen, Facial Action Coding System, 1978): anger 4 + 5 + 7 + 23, fear
1 + 2 + 4 + 5 + 20 + 26, sadness 1 + 4 + 15, often with 17. `force` scales what the muscles do; what differs in kind
between the two strengths is said where it is.
"""

from __future__ import annotations

from engine.performances.catalogue import performance
from engine.performances.modelling.figure import Pose
from engine.performances.scores.acting import Units, add, add_both_sides, head_sway, lids, pose, sum_turns
from engine.performances.scores.timing import blink, glances, swell


def anger(t: float) -> Pose:
    """A stare: the brows come down, the lids tighten, the lips are pressed thin, the head comes forward."""
    units: Units = {}
    hold = _glare(units, t, force=0.9)
    lids(units, blink(t, 0.20, depth=0.9) + blink(t, 2.12), lead=0.02)
    head = sum_turns((2.6 * hold, -1.6 * hold, 0.8 * hold), head_sway(t, 201, performance("anger").seconds, 0.4))
    gaze = glances(t, ((-1, 0, 0), (0.28, 0.5, 0.6), (1.5, 0.3, -0.4), (2.15, 0, 0)))
    return pose(units, head, gaze, 0.4 * hold, (0.0, 0.0, 0.006 * hold))


def anger_strong(t: float) -> Pose:
    """Rage: a glare, the lips square over both rows of teeth, the nose wrinkled, the head trembles."""
    units: Units = {}
    bared = swell(t, 0.62, 1.05, 1.75, 2.40, sag=0.12)
    hold = _glare(units, t, force=1.08, pursed=1 - 0.85 * bared)
    add_both_sides(units, "eyeWide", 0.40 * bared)  # a glare: without it a bared mouth is one of disgust
    add_both_sides(units, "noseSneer", 0.30 * bared)
    add_both_sides(units, "mouthUpperUp", 0.45 * bared)
    add_both_sides(units, "mouthLowerDown", 1.00 * bared)
    add_both_sides(units, "mouthStretch", 0.45 * bared)
    add_both_sides(units, "mouthFrown", 0.12 * bared)
    add(units, "jawOpen", 0.18 * bared)
    lids(units, blink(t, 0.16, depth=0.9) + blink(t, 2.16), lead=0.02)
    tremble = (0.0, 0.0, 0.28 * bared)
    head = sum_turns((4.6 * hold, 2.2 * hold, -1.4 * hold), head_sway(t, 211, performance("anger-strong").seconds, 0.7))
    head = sum_turns(head, tremble)
    gaze = glances(t, ((-1, 0, 0), (0.22, 0.4, -0.6), (1.4, 0.2, 0.5), (2.2, 0, 0)))
    return pose(units, head, gaze, 0.8 * hold, (0.0, 0.0, 0.012 * hold))


def _glare(units: Units, t: float, force: float, pursed: float = 1.0) -> float:
    """Brows and lids of anger, and lips rolled in as far as they are `pursed`; returns how far it is held."""
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.025, 0.94)):
        brow = force * more * swell(t - lag, 0.28, 0.72, 1.80, 2.50, sag=0.10)
        lid = force * more * swell(t - lag, 0.34, 0.75, 1.80, 2.45, sag=0.10)
        add(units, f"browDown{side}", 1.14 * brow)
        add(units, f"noseSneer{side}", 0.36 * brow)
        add(units, f"eyeSquint{side}", 0.55 * lid)
        add(units, f"eyeWide{side}", 0.48 * lid)
        add(units, f"mouthFrown{side}", 0.48 * lid)
    tight = force * pursed * swell(t, 0.46, 0.90, 1.70, 2.35, sag=0.12)
    add(units, "browInnerUp", -0.10 * tight)
    # the ring of the mouth tightens: thin lips, a little narrower (pressing them would draw the corners up)
    add(units, "mouthRollLower", 0.50 * tight)
    add(units, "mouthRollUpper", 0.42 * tight)
    add(units, "mouthPucker", 0.16 * tight)
    add(units, "mouthShrugLower", 0.24 * tight)
    add(units, "jawForward", 0.15 * tight)
    return swell(t, 0.32, 0.85, 1.75, 2.55, sag=0.1)


def fear(t: float) -> Pose:
    """Alarm: the brows rise and draw together, the eyes open wide and look about, the lips are drawn aside."""
    units: Units = {}
    hold = _dread(units, t, force=0.85)
    add(units, "jawOpen", 0.09 * swell(t, 0.46, 0.86, 1.70, 2.30))
    lids(units, blink(t, 0.15, depth=0.6, slow=0.8) + blink(t, 2.04), lead=0.0)
    head = sum_turns((-2.0 * hold, 2.4 * hold, 0.8 * hold), head_sway(t, 221, performance("fear").seconds, 0.5))
    gaze = glances(t, ((-1, 0, 0), (0.95, 0.0, 3.4), (1.30, 0.2, -2.8), (1.72, 0, 0)))
    return pose(units, head, gaze, 0.7 * hold, (0.002 * hold, 0.0, -0.007 * hold))


def fear_strong(t: float) -> Pose:
    """Terror: the mouth is torn open, the head draws back and away, the breath comes in gasps."""
    units: Units = {}
    hold = _dread(units, t, force=1.16)
    gape = swell(t, 0.40, 0.80, 1.75, 2.40, sag=0.15)
    gasp = gape * swell(t, 1.05, 1.25, 1.30, 1.55)
    add(units, "jawOpen", 0.34 * gape + 0.10 * gasp)
    add_both_sides(units, "mouthLowerDown", 0.34 * gape)
    add_both_sides(units, "mouthUpperUp", 0.12 * gape)
    lids(units, blink(t, 0.12, depth=0.6, slow=0.8) + blink(t, 2.14), lead=0.0)
    head = sum_turns(
        (-4.2 * hold, -4.4 * hold, -2.0 * hold), head_sway(t, 231, performance("fear-strong").seconds, 0.9)
    )
    gaze = glances(t, ((-1, 0, 0), (0.88, -0.4, -3.0), (1.16, 0.6, 2.6), (1.50, 0.0, -1.6), (1.90, 0, 0)))
    return pose(units, head, gaze, min(0.9 * hold + 0.3 * gasp, 1.0), (-0.003 * hold, 0.002 * gasp, -0.014 * hold))


def _dread(units: Units, t: float, force: float) -> float:
    """Brows, lids and drawn lips of fear; returns how far it is held."""
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.02, 0.95)):
        brow = force * more * swell(t - lag, 0.24, 0.56, 1.75, 2.50, sag=0.10)
        add(units, f"browOuterUp{side}", 0.34 * brow)
        add(units, f"browDown{side}", 0.34 * brow)
        add(units, f"eyeWide{side}", 1.0 * force * more * swell(t - lag, 0.22, 0.44, 1.70, 2.35, sag=0.15))
        add(units, f"mouthStretch{side}", 0.66 * force * more * swell(t - lag, 0.38, 0.80, 1.72, 2.35, sag=0.12))
        add(units, f"mouthFrown{side}", 0.16 * force * more * swell(t - lag, 0.38, 0.80, 1.72, 2.35))
    add(units, "browInnerUp", 1.02 * force * swell(t, 0.24, 0.58, 1.75, 2.52, sag=0.10))
    return swell(t, 0.26, 0.66, 1.70, 2.55, sag=0.15)


def sadness(t: float) -> Pose:
    """The inner brows rise, the corners of the mouth sink, the lids grow heavy and the eyes look down."""
    units: Units = {}
    hold = _sorrow(units, t, force=0.85)
    lids(units, blink(t, 0.62, slow=1.25) + 0.20 * swell(t, 0.8, 1.4, 2.0, 2.6) + blink(t, 2.30, slow=1.1), lead=0.02)
    head = sum_turns((4.2 * hold, 1.2 * hold, 2.2 * hold), head_sway(t, 241, performance("sadness").seconds, 0.35))
    gaze = glances(t, ((-1, 0, 0), (0.66, -5.5, 1.0), (1.55, -7.0, -0.6), (2.34, 0, 0)))
    return pose(units, head, gaze, 0.5 * swell(t, 0.1, 0.6, 0.7, 1.6), (0.0, -0.002 * hold, 0.0))


def sadness_strong(t: float) -> Pose:
    """Grief: near to tears; the chin is pushed up and trembles, a sigh lifts the shoulders, the head sinks aside."""
    units: Units = {}
    hold = _sorrow(units, t, force=1.22)
    shiver = swell(t, 0.95, 1.2, 1.6, 2.1)
    add_both_sides(units, "eyeSquint", 0.34 * swell(t, 0.6, 1.2, 2.0, 2.7))
    add_both_sides(units, "cheekSquint", 0.26 * swell(t, 0.6, 1.2, 2.0, 2.7))
    add_both_sides(units, "mouthStretch", 0.22 * swell(t, 0.6, 1.15, 2.0, 2.7))
    add(units, "mouthShrugLower", 0.16 * shiver)
    lids(units, blink(t, 0.50, slow=1.25) + 0.30 * swell(t, 0.7, 1.3, 2.1, 2.7) + blink(t, 2.46, slow=1.1), lead=0.02)
    head = sum_turns(
        (6.4 * hold, -2.4 * hold, -4.0 * hold), head_sway(t, 251, performance("sadness-strong").seconds, 0.5)
    )
    gaze = glances(t, ((-1, 0, 0), (0.54, -6.5, -1.4), (1.60, -8.5, 1.0), (2.50, 0, 0)))
    return pose(units, head, gaze, 0.9 * swell(t, 0.3, 0.85, 0.95, 2.0), (0.0, -0.003 * hold, 0.002 * hold))


def _sorrow(units: Units, t: float, force: float) -> float:
    """Brows and mouth of sadness; slower than all others. Returns how far it is held."""
    for side, lag, more in (("Left", 0.0, 1.0), ("Right", 0.03, 0.94)):
        brow = force * more * swell(t - lag, 0.32, 0.95, 2.05, 2.80, sag=0.08)
        add(units, f"browDown{side}", 0.20 * brow)
        add(units, f"mouthFrown{side}", 0.82 * force * more * swell(t - lag, 0.42, 1.10, 2.05, 2.82, sag=0.08))
    add(units, "browInnerUp", 1.0 * force * swell(t, 0.30, 0.92, 2.05, 2.80, sag=0.08))
    add(units, "mouthShrugLower", 0.36 * force * swell(t, 0.50, 1.15, 1.95, 2.70, sag=0.1))
    add_both_sides(units, "mouthPress", 0.14 * force * swell(t, 0.50, 1.15, 1.95, 2.70))
    return swell(t, 0.40, 1.15, 1.95, 2.85, sag=0.05)
