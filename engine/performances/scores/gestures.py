"""Nod, shake and wink: what a head and an eye say without an emotion."""

from __future__ import annotations

import math

from engine.performances.catalogue import performance
from engine.performances.modelling.figure import Pose
from engine.performances.scores.acting import Units, add, add_both_sides, head_sway, lids, pose, sum_turns
from engine.performances.scores.timing import blink, ease, glances, swell


def nod(t: float) -> Pose:
    """Twice down, the second time less: yes."""
    units: Units = {}
    pitch = _beats(t, 0.22, (0.62, 0.56), (7.0, 4.2))
    lids(units, blink(t, 0.30), lead=0.02)
    add_both_sides(units, "mouthSmile", 0.12 * swell(t, 0.2, 0.6, 1.1, 1.6))
    add_both_sides(units, "browOuterUp", 0.12 * swell(t, 0.15, 0.4, 0.6, 1.1))
    head = sum_turns((pitch, 0.0, 0.0), head_sway(t, 301, performance("nod").seconds, 0.4))
    return pose(units, head, (0.0, 0.0), 0.0, (0.0, 0.0, 0.0005 * pitch))


def nod_strong(t: float) -> Pose:
    """Three times down, from above the level, with lips pressed and brows at work: yes, indeed."""
    units: Units = {}
    lift = -2.6 * swell(t, 0.10, 0.30, 0.32, 0.60)
    pitch = lift + _beats(t, 0.24, (0.60, 0.54, 0.52), (10.5, 8.5, 5.0))
    lids(units, blink(t, 0.30) + blink(t, 1.34), lead=0.02)
    add_both_sides(units, "mouthPress", 0.4 * swell(t, 0.3, 0.7, 1.3, 1.8))
    add(units, "mouthShrugLower", 0.22 * swell(t, 0.3, 0.7, 1.3, 1.8))
    add_both_sides(units, "browOuterUp", 0.30 * swell(t, 0.06, 0.3, 0.4, 0.9))
    add(units, "browInnerUp", 0.24 * swell(t, 0.06, 0.3, 0.4, 0.9))
    head = sum_turns((pitch, 0.0, 0.0), head_sway(t, 311, performance("nod-strong").seconds, 0.6))
    return pose(units, head, (0.0, 0.0), 0.0, (0.0, 0.0, 0.0006 * pitch))


def shake(t: float) -> Pose:
    """Left, right, left, right, dying away: no."""
    units: Units = {}
    yaw = _swings(t, 0.16, 0.72, 7.5, turns=4)
    lids(units, blink(t, 0.22), lead=0.02)
    add_both_sides(units, "mouthPress", 0.3 * swell(t, 0.25, 0.6, 1.2, 1.7))
    add_both_sides(units, "browDown", 0.12 * swell(t, 0.25, 0.6, 1.2, 1.7))
    head = sum_turns((0.0, yaw, -0.12 * yaw), head_sway(t, 321, performance("shake").seconds, 0.4))
    return pose(units, head, (0.0, 0.0), 0.0, (0.00025 * yaw, 0.0, 0.0))


def shake_strong(t: float) -> Pose:
    """Wider, with the brows drawn together and the mouth turned down: certainly not."""
    units: Units = {}
    yaw = _swings(t, 0.16, 0.84, 12.0, turns=5)
    lids(units, blink(t, 0.22) + blink(t, 1.70), lead=0.02)
    add_both_sides(units, "mouthFrown", 0.42 * swell(t, 0.25, 0.7, 1.7, 2.3))
    add(units, "mouthShrugLower", 0.30 * swell(t, 0.25, 0.7, 1.7, 2.3))
    add_both_sides(units, "mouthPress", 0.22 * swell(t, 0.25, 0.7, 1.7, 2.3))
    add_both_sides(units, "browDown", 0.42 * swell(t, 0.2, 0.6, 1.7, 2.3))
    pitch = 1.6 * swell(t, 0.2, 0.7, 1.7, 2.3)
    head = sum_turns((pitch, yaw, -0.14 * yaw), head_sway(t, 331, performance("shake-strong").seconds, 0.5))
    return pose(units, head, (0.0, 0.0), 0.0, (0.0003 * yaw, 0.0, 0.0))


def wink(t: float) -> Pose:
    """One eye shuts, the cheek under it rises, that corner of the mouth goes along."""
    return _wink(t, performance("wink").seconds, force=0.8, tilt=2.4)


def wink_strong(t: float) -> Pose:
    """A wink with half a grin, the other brow up and the head cocked."""
    strong = _wink(t, performance("wink-strong").seconds, force=1.12, tilt=5.0)
    units = dict(strong.units)
    grin = swell(t, 0.28, 0.66, 1.05, 1.55, sag=0.1)
    add(units, "mouthUpperUpLeft", 0.24 * grin)
    add(units, "mouthSmileRight", 0.26 * grin)
    add(units, "jawOpen", 0.05 * grin)
    add(units, "browOuterUpRight", 0.62 * swell(t, 0.30, 0.58, 0.95, 1.45))
    return Pose(units=units, head=strong.head, lean=strong.lean, gaze=strong.gaze, breath=strong.breath)


def _wink(t: float, seconds: float, force: float, tilt: float) -> Pose:
    units: Units = {}
    lids(units, blink(t, seconds - 0.52, slow=0.85), lead=0.0)
    shut = swell(t, 0.34, 0.50, 0.74, 1.00)
    add(units, "eyeBlinkLeft", shut)
    units["eyeBlinkLeft"] = min(units["eyeBlinkLeft"], 1.0)
    around = force * swell(t, 0.28, 0.54, 0.80, 1.25)
    smile = force * swell(t, 0.26, 0.60, 0.95, 1.55, sag=0.1)
    add(units, "cheekSquintLeft", 0.85 * around)
    add(units, "browDownLeft", 0.38 * around)
    add(units, "eyeSquintLeft", 0.20 * around)
    add(units, "noseSneerLeft", 0.14 * around)
    add(units, "mouthSmileLeft", 0.72 * smile)
    add(units, "mouthDimpleLeft", 0.22 * smile)
    add(units, "mouthSmileRight", 0.18 * smile)
    head = sum_turns((0.9 * smile, 0.8 * smile, tilt * smile), head_sway(t, 341, seconds, 0.35))
    return pose(units, head, glances(t, ((-1, 0, 0), (0.2, 0.3, 0.5), (1.1, 0, 0))), 0.0)


def _beats(t: float, start: float, periods: tuple[float, ...], degrees: tuple[float, ...]) -> float:
    """Dips of the head, one after the other: each goes down and comes back along half a wave."""
    pitch = 0.0
    for period, depth in zip(periods, degrees, strict=True):
        x = min(max((t - start) / period, 0.0), 1.0)
        pitch += depth * (0.5 - 0.5 * math.cos(2 * math.pi * x))
        start += period
    return pitch


def _swings(t: float, start: float, period: float, degrees: float, turns: int) -> float:
    """A head that swings to both sides, `turns` half waves, growing and dying away."""
    length = turns * period / 2
    rise = ease(t, start, start + 0.45 * period) * (1 - ease(t, start + length - 0.75 * period, start + length))
    return degrees * rise * math.sin(2 * math.pi * (t - start) / period)
