"""Walks in place, walking.

Whoever walks on a treadmill, or in a clip exported in place, has feet that stand and go back evenly with the ground
under them: the body goes on by as much.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from engine.geometry.rigging.skeleton import Skeleton
from engine.motion.clip import Clip
from engine.motion.edit import loop_travel
from engine.motion.feet.foot_contact import REFERENCE_LEG_METRES, sole_places
from engine.motion.feet.sole import leg_length

Array = NDArray[np.float64]

MIN_GROUND_METRES_PER_SECOND = 0.2
"""Metres a second, for legs of `REFERENCE_LEG_METRES`: feet that go back slower than this shuffle."""

CONTACT_HEIGHT_SCALE_METRES = 0.01
"""Metres, for legs of `REFERENCE_LEG_METRES`: how far above the lowest point of both soles another hardly stands."""

STEP_TOLERANCE = 0.5
"""How far a point's step may differ from the ground's and still go with it, as a share of the ground's."""

GROUND_STEP_ROUNDS = 6
"""Rounds of finding the ground's step by the points that go with it."""

MIN_CONTACT_SHARE = 0.5
"""The share of the time in which something goes with the ground, at least."""

MIN_FOOT_SHARE = 0.2
"""Each foot's share of what goes with the ground, at least."""

MAX_HEIGHT_SPREAD_METRES = 0.03
"""Metres, for legs of `REFERENCE_LEG_METRES`: what goes with the ground at heights that differ by more, pedals, say."""

MAX_ROOT_TRAVEL_SHARE = 0.25
"""What the root may travel by itself, as a share of the ground's way."""

SPEED_SIGMA_SECONDS = 0.06
"""Seconds over which the body's speed is evened out."""

AIRBORNE_WEIGHT = 0.05
"""The weight of the ground's mean step beside those of the points that stand (0 to 1 each)."""


def travel_as_walked(skeleton: Skeleton, clip: Clip) -> Clip:
    """The clip travelling as its feet walk, if it is a walk in place; else the same clip."""
    scale = leg_length(skeleton) / REFERENCE_LEG_METRES
    if len(clip.rotations) < 3:
        return clip
    steps, heights = _steps(skeleton, clip)
    lowest = np.exp((heights.min(1, keepdims=True) - heights) / (CONTACT_HEIGHT_SCALE_METRES * scale))
    ground = np.median((steps * lowest[..., None]).sum(1) / lowest.sum(1)[:, None], axis=0)
    for _ in range(GROUND_STEP_ROUNDS):
        speed = float(np.linalg.norm(ground))
        if speed * clip.fps < MIN_GROUND_METRES_PER_SECOND * scale:
            return clip
        stands = lowest * np.exp(-((np.linalg.norm(steps - ground, axis=-1) / (STEP_TOLERANCE * speed)) ** 2))
        ground = (steps * stands[..., None]).sum((0, 1)) / stands.sum()
    left = stands[:, :3].sum() / stands.sum()
    own = loop_travel(clip) if clip.loops else (clip.root[-1] - clip.root[0]) * [1, 0, 1]
    level = np.abs(heights - (heights * stands).sum() / stands.sum()) < MAX_HEIGHT_SPREAD_METRES * scale
    walks = (stands * level).max(1).mean() > MIN_CONTACT_SHARE and MIN_FOOT_SHARE < left < 1 - MIN_FOOT_SHARE
    if not walks or np.linalg.norm(own) > MAX_ROOT_TRAVEL_SHARE * speed * len(steps):
        return clip
    return replace(clip, root=(clip.root + _way(steps, stands, ground, clip)).astype(np.float32))


def _way(steps: Array, stands: Array, ground: Array, clip: Clip) -> Array:
    """(F, 3) how far the body goes on: as what stands goes back, and evenly while hardly anything stands."""
    back = (steps * stands[..., None]).sum(1) + AIRBORNE_WEIGHT * ground
    weights = stands.sum(1) + AIRBORNE_WEIGHT
    mode: Literal["wrap", "nearest"] = "wrap" if clip.loops else "nearest"
    smooth = [
        gaussian_filter1d(values, SPEED_SIGMA_SECONDS * clip.fps, axis=0, mode=mode)
        for values in (back, weights[:, None])
    ]
    return np.concatenate([np.zeros((1, 3)), -np.cumsum(smooth[0] / smooth[1], axis=0)])[: len(clip.rotations)]


def _steps(skeleton: Skeleton, clip: Clip) -> tuple[Array, Array]:
    """How far heels, balls and tips of both feet go over the ground from frame to frame (S, 6, 3), and their heights
    (S, 6); of a loop also from the last frame to the first."""
    points = sole_places(skeleton, clip).reshape(len(clip.rotations), 6, 3)
    if clip.loops:
        points = np.concatenate([points, points[:1] + loop_travel(clip)])
    return np.diff(points, axis=0) * [1, 0, 1], (points[:-1, :, 1] + points[1:, :, 1]) / 2
