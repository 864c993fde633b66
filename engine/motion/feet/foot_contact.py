"""When feet stand on the ground, and how well they do it.

A foot stands while its heel or its ball is low and slow (Kovar, Schreiner and Gleicher, "Footskate cleanup for motion
capture editing", 2002, section 3). A foot that stands goes on standing a little beyond both limits, so that noise does
not end it. A foot that wanders off while it seems to stand, shuffles: it is let go while it does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.feet.sole import soles
from engine.motion.kinematics import place_joints, world_rotations

Array = NDArray[np.float64]
Contacts = NDArray[np.bool_]

REFERENCE_LEG_METRES = 0.85
"""Metres of the legs for which lengths and speeds are given here: those of others are in proportion."""

CONTACT_HEIGHT_METRES = 0.05
"""Metres, for legs of `REFERENCE_LEG_METRES`: heel or ball are lower while a foot begins to stand."""
RELEASE_HEIGHT_METRES = 0.08
"""Metres, for legs of `REFERENCE_LEG_METRES`: heel or ball are lower while a foot goes on standing."""

CONTACT_METRES_PER_SECOND = 0.4
"""Metres a second, for legs of `REFERENCE_LEG_METRES`: heel or ball are slower while a foot begins to stand."""
RELEASE_METRES_PER_SECOND = 0.7
"""Metres a second, for legs of `REFERENCE_LEG_METRES`: heel or ball are slower while a foot goes on standing."""

MAX_FOOT_DRIFT_METRES = 0.06
"""Metres, for legs of `REFERENCE_LEG_METRES`: a foot whose ball wanders farther than this from its place, shuffles."""

MIN_CONTACT_SECONDS = 0.07
"""Seconds that a foot must stand, at least; a gap that is shorter is none."""


@dataclass(frozen=True)
class FeetReport:
    """How well feet stand, before and after they were held.

    sliding_before, sliding_after : cm/s, the mean speed over the ground of the slower of heel and ball while the foot stands.
    sinking_before, sinking_after : cm, the deepest that a sole goes under the ground.
    standing : the share of frames in which some foot stands.
    """

    sliding_before: float
    sliding_after: float
    sinking_before: float
    sinking_after: float
    standing: float


def sole_places(skeleton: Skeleton, clip: Clip) -> Array:
    """(F, 2, 3, 3): of the left and the right foot, where heel, ball and tip are, metres."""
    world = world_rotations(skeleton.parents, clip.rotations)
    places = place_joints(skeleton.parents, skeleton.offsets(), world, clip.root)
    points = []
    for sole in soles(skeleton):
        ankle, toe = sole.joints[2:]
        foot = world[:, ankle]
        points.append(sole.points(places[:, ankle], foot, world[:, toe] if toe >= 0 else foot))
    return np.stack(points, 1)


def find_contacts(points: Array, fps: float, leg: float = REFERENCE_LEG_METRES) -> Contacts:
    """(F, 2) bool: in which frames each foot stands, from `sole_places`; `leg` metres long."""
    scale = leg / REFERENCE_LEG_METRES
    heights = points[:, :, :2, 1] / scale
    speeds = _speeds(points[:, :, :2], fps) / scale
    begins = np.any((heights < CONTACT_HEIGHT_METRES) & (speeds < CONTACT_METRES_PER_SECOND), axis=-1)
    lasts = np.any((heights < RELEASE_HEIGHT_METRES) & (speeds < RELEASE_METRES_PER_SECOND), axis=-1)
    shortest = max(round(MIN_CONTACT_SECONDS * fps), 1)
    contacts = np.zeros(begins.shape, bool)
    for side in range(2):
        held = _hysteresis(begins[:, side], lasts[:, side])
        held = ~_without_short(~held, shortest, edges=True)
        held = _without_short(held, shortest, edges=True)
        contacts[:, side] = _without_shuffling(held, points[:, side, 1] / scale, fps)
    return contacts


def floor_height(points: Array, fps: float) -> float:
    """How high the ground lies, metres: the median height of soles while they are the lowest and slow."""
    frames = np.arange(len(points))
    flat = points[:, :, :2].reshape(len(points), 4, 3)
    speeds = _speeds(flat, fps)
    lowest = flat[..., 1].argmin(1)
    heights = flat[frames, lowest, 1]
    slow = speeds[frames, lowest] < CONTACT_METRES_PER_SECOND
    low = heights < np.percentile(heights, 10) + 0.15
    chosen = heights[slow & low]
    return float(np.median(chosen) if len(chosen) >= max(2, 0.05 * len(heights)) else np.percentile(heights, 10))


def sliding_speed(points: Array, contacts: Contacts, fps: float) -> float:
    """Mean speed over the ground, cm/s, of the slower of heel and ball while the foot stands; 0 if none does."""
    if len(points) < 2:
        return 0.0
    steps = np.linalg.norm(np.diff(points[:, :, :2, [0, 2]], axis=0), axis=-1).min(-1) * fps
    both = contacts[1:] & contacts[:-1]
    return float(steps[both].mean() * 100) if both.any() else 0.0


def sinking_depth(points: Array) -> float:
    """The deepest place of a sole under the ground, cm."""
    return float(max(-points[..., 1].min(), 0.0) * 100)


def true_runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def _speeds(points: Array, fps: float) -> Array:
    """Speeds of points (F, ..., 3) by central differences, metres a second."""
    if len(points) < 2:
        return np.zeros(points.shape[:-1])
    return np.asarray(np.linalg.norm(np.gradient(points, axis=0), axis=-1) * fps)


def _hysteresis(begins: NDArray[np.bool_], lasts: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Runs of `lasts` that hold a frame of `begins`."""
    held = np.zeros(len(begins), bool)
    for first, last in true_runs(lasts | begins):
        held[first : last + 1] = begins[first : last + 1].any()
    return held


def _without_short(flags: NDArray[np.bool_], shortest: int, edges: bool) -> NDArray[np.bool_]:
    """Without the runs shorter than `shortest`, unless they touch the beginning or the end."""
    kept = flags.copy()
    for first, last in true_runs(flags):
        at_edge = edges and (first == 0 or last == len(flags) - 1)
        if last - first + 1 < shortest and not at_edge:
            kept[first : last + 1] = False
    return kept


def _without_shuffling(stands: NDArray[np.bool_], ball: Array, fps: float) -> NDArray[np.bool_]:
    """Without the tenths of a second about the fastest moment of each span in which the ball (F, 3) wanders off, and so
    on in what is left."""
    kept = stands.copy()
    level = ball[:, [0, 2]]
    speeds = _speeds(level, fps)
    reach, shortest = max(round(0.1 * fps), 1), max(round(MIN_CONTACT_SECONDS * fps), 1)
    waiting = true_runs(kept)
    while waiting:
        first, last = waiting.pop()
        here = level[first : last + 1]
        if np.linalg.norm(here - np.median(here, axis=0), axis=1).max() <= MAX_FOOT_DRIFT_METRES:
            continue
        fastest = first + int(np.argmax(speeds[first : last + 1]))
        begin, end = max(fastest - reach, first), min(fastest + reach, last)
        kept[begin : end + 1] = False
        for piece in ((first, begin - 1), (end + 1, last)):
            if piece[1] - piece[0] + 1 >= shortest:
                waiting.append(piece)
            else:
                kept[piece[0] : piece[1] + 1] = False
    return kept
