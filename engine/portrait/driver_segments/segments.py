"""From frames to segments: where each state begins and ends, and which few segments are worth offering."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label, median_filter

from engine.perception.expression.prototypes import show
from engine.performances import PERFORMANCE_STATES, State
from engine.performances.catalogue import Strength
from engine.portrait.driver_segments.gestures import gestures
from engine.portrait.driver_segments.rest import distance_from_rest

ONSET_CLARITY = 1.0
"""How clearly a state shows, at least, where a segment begins (hysteresis)."""
OFFSET_CLARITY = 0.5
"""How clearly a state shows, at least, for its segment to last."""

HELD_SECONDS: Mapping[State, float] = {"wink": 0.25}
MIN_HELD_SECONDS = 0.35
"""Seconds for which a state is shown clearly: shorter ones are blinks, speech, or the tracker's doing."""

APEX_SHARE = 0.95
"""The share of the most of a state that counts as its height: its apex is in the middle of that."""

MAX_EXTENSION_SECONDS = 1.2
"""Seconds by which a segment is extended at most on either side to where the face is at rest."""

REST_MARGIN_SECONDS = 0.15
"""Seconds of rest that are kept at either end where there are as many."""

MAX_INWARD_SHARE = 0.25
"""The share of a gesture's length by which it may begin later or end earlier: to and fro passes by rest."""

CALM_UNREST = 1.0
"""The unrest with which a segment may begin and end."""
MAX_UNREST = 2.0
"""The unrest with which a segment may begin and end where there is none calmer, at a lower score."""

MIN_WAITING_SECONDS = 2.5
"""Seconds at rest that make a segment of waiting."""

CUT_SEGMENT_SECONDS = 8.0
"""Seconds after which talking and waiting are cut at rest."""
MAX_SEGMENT_SECONDS = 20.0
"""Seconds of a segment, at most: what lasts longer is none."""

STRONG_CLARITY = 1.5
"""How clearly a state must show to be called strong."""

MIN_SCORE = 0.4
"""The least score of a segment that is offered."""

MAX_PER_STATE = 3
"""Segments of each state that are offered."""


@dataclass(frozen=True)
class Segment:
    """Frames `first` to `last` (included) that hold a state, which is at its height in `apex`.

    clearly : how clearly it shows there; 1 is just clearly.
    rests : how far from rest the ends are, up to 1 is calm.
    """

    state: State
    first: int
    last: int
    apex: int
    clearly: float
    rests: float

    @property
    def strength(self) -> Strength:
        return "strong" if self.clearly >= STRONG_CLARITY and self.state != "idle" else "normal"

    @property
    def score(self) -> float:
        """How sure it is, in [0, 1]: 0.5 where the state shows just clearly, 1 where twice as much, less where it does
        not begin and end at rest."""
        return min(self.clearly / 2, 1.0) / max(self.rests, 1.0)


def detect_segments(
    values: NDArray[np.floating], found: NDArray[np.bool_], rest: NDArray[np.floating], fps: float
) -> list[Segment]:
    """The segments worth offering, in the order of the states, the best of each first.

    Parameters
    ----------
    values : (N, 12) the measures of every frame; whatever where no face was `found` (N,).
    rest : (12,) the person's measures at rest.
    fps : frames a second.
    """
    moved = np.asarray(values - rest, float)
    unresting = np.where(found, distance_from_rest(moved), np.inf)
    cores = [core for first, last in _runs(found) for core in _cores(moved, rest, first, last, fps)]
    cores = [core for core in cores if not _speech(core, cores)]
    extended = (_extended(core, cores, unresting, fps) for core in _strongest(cores))
    segments = [one for one in extended if one is not None and one.score >= MIN_SCORE]
    segments += _waiting(unresting, cores, fps)
    return [one for state in PERFORMANCE_STATES for one in _best(one for one in segments if one.state == state)]


def _cores(moved: NDArray[np.floating], rest: NDArray[np.floating], first: int, last: int, fps: float) -> list[Segment]:
    """Where states show within an uninterrupted run of frames, from where they rise to where they fall."""
    run = moved[first : last + 1]
    steady = median_filter(run, (3, 1), mode="nearest")
    cores = []
    for state, clearly in show(steady, rest).items():
        for begin, end in _runs(clearly >= OFFSET_CLARITY):
            part = clearly[begin : end + 1]
            if (part >= ONSET_CLARITY).sum() >= max(2, round(HELD_SECONDS.get(state, MIN_HELD_SECONDS) * fps)):
                top = np.flatnonzero(part >= APEX_SHARE * part.max())
                apex = begin + int(top[len(top) // 2])
                height = float(np.quantile(part, 0.9))
                cores.append(Segment(state, first + begin, first + end, first + apex, height, 1.0))
    cores += [
        Segment(one.state, first + one.first, first + one.last, first + one.apex, one.clearly, 1.0)
        for one in gestures(run, fps)
    ]
    return cores


def _speech(core: Segment, cores: list[Segment]) -> bool:
    """Whether something is but the play of the brows with which people underline what they say (Ekman, About Brows,
    1979)."""
    return core.state in ("surprise", "fear", "sadness") and any(
        one.state == "talk" and _shared(one, core) > 0.5 for one in cores
    )


def _strongest(cores: list[Segment]) -> list[Segment]:
    """Of emotions that are seen in the same moment, only the one that shows more clearly."""
    kept: list[Segment] = []
    for core in sorted(cores, key=lambda one: one.clearly, reverse=True):
        rivals = [one for one in kept if _emotional(one) and _emotional(core) and _shared(one, core) > 0.3]
        if not rivals:
            kept.append(core)
    return kept


def _extended(core: Segment, cores: list[Segment], unresting: NDArray[np.floating], fps: float) -> Segment | None:
    """The segment from rest to rest around a core; None where the face is not at rest near enough."""
    floor, ceiling = _room(core, cores, unresting)
    reach, margin = round(MAX_EXTENSION_SECONDS * fps), round(REST_MARGIN_SECONDS * fps)
    inward = 0 if _emotional(core) else round(MAX_INWARD_SHARE * (core.last - core.first))
    before = np.arange(max(core.first - reach, floor), min(core.first + inward, core.apex) + 1)[::-1]
    after = np.arange(max(core.last - inward, core.apex), min(core.last + reach, ceiling) + 1)
    begin, end = _rest_near(before, core.first, unresting), _rest_near(after, core.last, unresting)
    if begin is None or end is None:
        return None
    begin = _further(begin, -1, max(begin - margin, floor), unresting)
    end = _further(end, 1, min(end + margin, ceiling), unresting)
    if core.state == "talk" and end - begin > CUT_SEGMENT_SECONDS * fps:
        end = _cut(begin, unresting, fps)
    if end is None or end - begin > MAX_SEGMENT_SECONDS * fps:
        return None
    apex = min(max(core.apex, begin), end)
    return replace(core, first=begin, last=end, apex=apex, rests=float(max(unresting[begin], unresting[end])))


def _room(core: Segment, cores: list[Segment], unresting: NDArray[np.floating]) -> tuple[int, int]:
    """The first and last frame that a segment may have: half-way to the emotions before and after it, and as long as
    the face is seen. Talking keeps no distance from emotions, since it may show them."""
    others = [] if core.state == "talk" else [one for one in cores if _emotional(one) and _shared(one, core) <= 0.3]
    before = [(one.last + core.first) // 2 + 1 for one in others if one.last < core.apex]
    after = [(one.first + core.last) // 2 for one in others if one.first > core.apex]
    lost = np.flatnonzero(np.isinf(unresting))
    seen_from = int(lost[lost < core.first].max(initial=-1)) + 1
    seen_to = int(lost[lost > core.last].min(initial=len(unresting))) - 1
    return max([seen_from, *before]), min([seen_to, *after])


def _rest_near(places: NDArray[np.intp], core: int, unresting: NDArray[np.floating]) -> int | None:
    """Of some frames the one nearest to a core's end at which the face is calm, or else the calmest bearable one."""
    if len(places) == 0:
        return None
    calm = places[unresting[places] <= CALM_UNREST]
    if len(calm):
        return int(calm[np.argmin(np.abs(calm - core))])
    calmest = int(places[np.argmin(unresting[places])])
    return calmest if unresting[calmest] <= MAX_UNREST else None


def _further(place: int, step: int, most: int, unresting: NDArray[np.floating]) -> int:
    while place != most and unresting[place + step] <= min(CALM_UNREST, unresting[place]):
        place += step
    return place


def _cut(begin: int, unresting: NDArray[np.floating], fps: float) -> int | None:
    """The last calm frame before a segment that begins there becomes too long, or the calmest bearable one."""
    least, most = begin + round(CUT_SEGMENT_SECONDS * fps / 3), begin + round(CUT_SEGMENT_SECONDS * fps)
    places = np.arange(least, most + 1)
    return _rest_near(places, most, unresting)


def _waiting(unresting: NDArray[np.floating], cores: list[Segment], fps: float) -> list[Segment]:
    """Where the face is at rest for a while and nothing else happens."""
    quiet = unresting <= CALM_UNREST
    for core in cores:
        quiet[core.first : core.last + 1] = False
    segments = []
    for begin, end in _runs(quiet):
        if end - begin < MIN_WAITING_SECONDS * fps:
            continue
        last = min(end, begin + round(CUT_SEGMENT_SECONDS * fps))
        part = unresting[begin : last + 1]
        clearly = 2.0 - float(np.mean(part))
        segments.append(Segment("idle", begin, last, begin + int(np.argmin(part)), clearly, 1.0))
    return segments


def _best(segments: Iterable[Segment]) -> list[Segment]:
    """The best few that do not overlap."""
    kept: list[Segment] = []
    for one in sorted(segments, key=lambda one: (-one.score, one.first)):
        if all(one.last < other.first or one.first > other.last for other in kept):
            kept.append(one)
    return kept[:MAX_PER_STATE]


def _emotional(one: Segment) -> bool:
    return one.state not in ("idle", "nod", "shake", "talk")


def _shared(one: Segment, other: Segment) -> float:
    """The share of the shorter one that both have in common."""
    common = min(one.last, other.last) - max(one.first, other.first) + 1
    return max(common, 0) / (min(one.last - one.first, other.last - other.first) + 1)


def _runs(true: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of each run of True."""
    labels, count = label(true)
    return [(int(where[0]), int(where[-1])) for where in (np.flatnonzero(labels == one + 1) for one in range(count))]
