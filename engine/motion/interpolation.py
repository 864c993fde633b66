"""Turns and places between the frames of a motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.motion import rotation

Array = NDArray[np.float64]


def rotations_at(rotations: Array, times: Array) -> Array:
    """Turns (F, ..., 4) at fractional frames `times` (N,)."""
    first = np.clip(np.floor(times).astype(int), 0, max(len(rotations) - 2, 0))
    second = np.minimum(first + 1, len(rotations) - 1)
    share = (times - first).reshape(-1, *[1] * (rotations.ndim - 2))
    return rotation.slerp(rotations[first], rotations[second], share)


def places_at(places: Array, times: Array) -> Array:
    """Places (F, ..., 3) at fractional frames `times` (N,)."""
    first = np.clip(np.floor(times).astype(int), 0, max(len(places) - 2, 0))
    second = np.minimum(first + 1, len(places) - 1)
    share = (times - first).reshape(-1, *[1] * (places.ndim - 1))
    return np.asarray(places[first] * (1 - share) + places[second] * share)
