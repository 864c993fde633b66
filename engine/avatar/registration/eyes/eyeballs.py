"""Eyeballs, and what lies before them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

LID_GAP_METRES = 0.0004
"""Metres that lids stay before the eyeball."""


def before_eyeball(
    eyeball: NDArray[np.float64], points: NDArray[np.float64], gap: float = LID_GAP_METRES
) -> NDArray[np.float64]:
    """The points (N, 3), those inside of an eyeball (E, 3), or nearer than `gap`, moved out to so far before it."""
    middle, radius = sphere(eyeball)
    away = points - middle
    distance = np.linalg.norm(away, axis=1)
    surface = _reach(eyeball - middle, away / np.maximum(distance, 1e-12)[:, None], radius) + gap
    return np.asarray(middle + away * np.maximum(surface / np.maximum(distance, 1e-12), 1)[:, None])


def sphere(points: NDArray[np.floating]) -> tuple[NDArray[np.float64], float]:
    """The middle (3,) and the radius of the sphere on which points (N, 3) lie best, by linear least squares."""
    rows = np.column_stack([2 * points, np.ones(len(points))])
    solved = np.linalg.lstsq(rows, (points**2).sum(1), rcond=None)[0]
    middle = solved[:3]
    return np.asarray(middle), float(np.sqrt(solved[3] + middle @ middle))


def _reach(eyeball: NDArray[np.float64], directions: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """(N,) metres from the eyeball's middle to its surface along unit `directions` (N, 3): of the nearest vertex, the cornea's
    bulge included, and the sphere's at least."""
    length = np.linalg.norm(eyeball, axis=1)
    near = cKDTree(eyeball / length[:, None]).query(directions)[1]
    return np.maximum(length[near], radius)
