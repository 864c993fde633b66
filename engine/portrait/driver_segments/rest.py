"""The face at rest: what everything else that a person's face does is measured against."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from engine.perception.expression.measures import (
    FACE_MEASURES,
    LID_MEASURES,
    MEASURES,
    REST_SPREAD,
    SPREAD_BETWEEN_PEOPLE,
    general_rest,
    lid_lowering,
)

UNLIKE_REST_WEIGHT = 0.3
"""How much being unlike a resting face in general counts, against being unlike most of what this person shows."""

TARGET_LOWERED_LIDS_WEIGHT = 2.0
"""How much lowered lids count, as a share of how far they are usually open."""

NEIGHBOUR_SHARE = 0.04
"""The share of the frames that are compared with each: rest is what a face comes back to again and again."""

MIN_NEIGHBOURS = 5

_MEASURES_BUT_LIDS = np.delete(np.arange(len(MEASURES)), LID_MEASURES)


def own_rest(values: NDArray[np.floating]) -> NDArray[np.float64]:
    """The measures (12,) of this person at rest, from those of all frames (N, 12) that show the face.

    The frame that is closest to its nearest neighbours, and is not unlike a resting face at all. So a smile that lasts
    through half of a clip is not taken for rest, where the other half is quiet.

    It is a habit: a segment ends where the face has come back to what it comes back to, be that a little amused. A calm face
    that is seen in fewer than `NEIGHBOUR_SHARE` of the frames is an exception. `neutral.estimate_rest` looks for that one, however
    rare: in this place it finds two more of 80 joined performances, one wrongly, and misses a smile in the real clips
    (`benchmarks/driver_segments`).
    """
    neighbours = min(max(MIN_NEIGHBOURS, round(NEIGHBOUR_SHARE * len(values))), len(values) - 1)
    apart = np.sort(cdist(values / REST_SPREAD, values / REST_SPREAD), axis=1)[:, : neighbours + 1]
    unlike = np.sqrt(np.mean(((values - general_rest()) / SPREAD_BETWEEN_PEOPLE)[:, FACE_MEASURES] ** 2, axis=1))
    blinking = lid_lowering(values, np.quantile(values[:, LID_MEASURES], 0.7, axis=0))
    best = int(np.argmin(apart.mean(axis=1) + UNLIKE_REST_WEIGHT * unlike + TARGET_LOWERED_LIDS_WEIGHT * blinking))
    nearest = np.argsort(np.linalg.norm((values - values[best]) / REST_SPREAD, axis=1))[: neighbours + 1]
    return np.asarray(np.median(values[nearest], axis=0), float)


def distance_from_rest(moved: NDArray[np.floating]) -> NDArray[np.float64]:
    """(N,) how far from rest each frame is, from differences (N, 12): up to 1 it counts as calm. A blink is no unrest."""
    share = np.abs(moved) / REST_SPREAD
    blink = moved[:, LID_MEASURES].max(axis=1) < 0
    lids = np.where(blink, 0.0, share[:, LID_MEASURES].max(axis=1))
    return np.asarray(np.maximum(share[:, _MEASURES_BUT_LIDS].max(axis=1), lids), float)
