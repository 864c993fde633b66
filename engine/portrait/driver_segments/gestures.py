"""Movements to and fro: the head nods or shakes, the mouth talks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.measures import MEASURES
from engine.performances import State


@dataclass(frozen=True)
class Rhythm:
    """What makes a movement to and fro a gesture.

    measure : one of `MEASURES`.
    swing : what one way to or fro covers at least, in the measure's unit; `clear` : where it is beyond doubt.
    seconds : how long one way takes at most.
    pause : what lies between two at most.
    times : how many ways there are at least.
    """

    measure: str
    swing: float
    clear: float
    seconds: float
    pause: float
    times: int


RHYTHMS: Mapping[State, Rhythm] = {
    "nod": Rhythm("pitch", 0.055, 0.09, 0.85, 0.60, 3),
    "shake": Rhythm("yaw", 0.07, 0.16, 0.70, 0.60, 3),
    "talk": Rhythm("mouth_open", 0.05, 0.11, 0.85, 0.85, 5),
}
"""A nod covers 3 degrees at least and comes twice, a shake 4 degrees, each way within three quarters of a second: heads
that listen or look about move by less or more slowly (idle performances, clips of `benchmarks/driver_segments`). A mouth that
talks opens and shuts by a twentieth of the eyes' distance, five ways or more without a longer pause."""

MAX_TALKING_OPENING_EYE_DISTANCES = 0.38
"""Eye distances by which a mouth that talks opens at most, but for a tenth of the time: beyond, it makes faces (the
clips' talkers open theirs by 0.25 to 0.33, the one who makes faces by 0.53)."""

MAX_SILENT_OPENING_EYE_DISTANCES = 0.09
"""Eye distances by which the mouth may move during a nod or shake: a head that speaks along is no clear gesture."""

MIN_CLARITY = 0.8
"""How large most ways of a gesture are at least, against a clear one."""

MIN_AXIS_RATIO = 1.2
"""By how many times a nodding head's pitch moves more than its yaw, and a shaking one's yaw more than its pitch."""


REST_SHARE = 0.15
"""The share of a way at either end that counts as resting there already."""


@dataclass(frozen=True)
class Gesture:
    """A gesture from frame `first` to `last`, `clearly` by 1 and more, at its height in `apex`."""

    state: State
    first: int
    last: int
    apex: int
    clearly: float


def gestures(values: NDArray[np.floating], fps: float) -> list[Gesture]:
    """All gestures in the measures (N, 12) of consecutive frames."""
    found = [one for state in RHYTHMS for one in _one_kind(state, values, fps) if one.clearly >= MIN_CLARITY]
    return [one for one in found if _alone(one, values)]


@dataclass(frozen=True)
class Swing:
    """One way to or fro: the frames from `first` to `last` in which a measure moves by `size`."""

    first: int
    last: int
    size: float


def swings(curve: NDArray[np.floating], least: float) -> list[Swing]:
    """The ways to and fro of a curve (N,) that cover `least` at least, without the rests between them."""
    points = _turning_points(curve, least)
    found = []
    for begin, end in pairwise(points):
        way = np.abs(curve[begin : end + 1] - curve[begin]) / abs(curve[end] - curve[begin])
        last = begin + int(np.argmax(way >= 1 - REST_SHARE))
        first = begin + int(np.flatnonzero(way[: last - begin + 1] <= REST_SHARE)[-1])
        found.append(Swing(first, last, float(abs(curve[end] - curve[begin]))))
    return found


def _turning_points(curve: NDArray[np.floating], least: float) -> list[int]:
    """The frames at which a curve turns back by `least` at least, from the one where it first sets out."""
    low = high = 0
    points: list[int] = []
    rising = True
    for place, value in enumerate(curve):
        if not points:
            low = place if value < curve[low] else low
            high = place if value > curve[high] else high
            if curve[high] - curve[low] >= least:
                rising = high > low
                points = [low, high] if rising else [high, low]
        elif (value > curve[points[-1]]) == rising and value != curve[points[-1]]:
            points[-1] = place
        elif abs(value - curve[points[-1]]) >= least:
            points.append(place)
            rising = not rising
    return points


def _one_kind(state: State, values: NDArray[np.floating], fps: float) -> list[Gesture]:
    rhythm = RHYTHMS[state]
    curve = values[:, MEASURES.index(rhythm.measure)]
    longest, pause = rhythm.seconds * fps, rhythm.pause * fps
    mouth = values[:, MEASURES.index("mouth_open")]
    runs: list[list[Swing]] = [[]]
    for one in swings(curve, rhythm.swing):
        if runs[-1] and one.first - runs[-1][-1].last > pause:
            runs.append([])
        speaks = state != "talk" and np.ptp(mouth[one.first : one.last + 1]) > MAX_SILENT_OPENING_EYE_DISTANCES
        if one.last - one.first <= longest and not speaks:
            runs[-1].append(one)
        else:
            runs.append([])
    return [_gesture(state, curve, run) for run in runs if len(run) >= rhythm.times]


def _gesture(state: State, curve: NDArray[np.floating], run: list[Swing]) -> Gesture:
    ends = [one.last for one in run]
    apex = ends[int(np.argmax(np.abs(curve[ends] - np.median(curve[ends]))))]
    size = float(np.median([one.size for one in run]))
    return Gesture(state, run[0].first, run[-1].last, apex, size / RHYTHMS[state].clear)


def _alone(one: Gesture, values: NDArray[np.floating]) -> bool:
    """Whether it is that gesture and no other movement that it comes along with."""
    of = dict(zip(MEASURES, values[one.first : one.last + 1].T, strict=True))
    way = {name: float(np.abs(np.diff(of[name])).sum()) for name in ("yaw", "pitch", "roll")}
    if one.state == "talk":
        return float(np.quantile(of["mouth_open"], 0.9) - of["mouth_open"].min()) <= MAX_TALKING_OPENING_EYE_DISTANCES
    if np.ptp(of["mouth_open"]) > MAX_SILENT_OPENING_EYE_DISTANCES:
        return False
    own = way.pop(RHYTHMS[one.state].measure)
    return own >= MIN_AXIS_RATIO * max(way.values())
