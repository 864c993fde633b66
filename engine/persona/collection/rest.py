"""A person's average face, of many photographs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import mouth_opening
from engine.persona.texture.expression_weights import expression_points

NEUTRAL_SHARE = 0.25
"""Of the photographs, those whose expression is nearest to the median one: their mean is the face at rest."""


def at_rest(front: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) of faces `front` (N, 478, 3), turned to the front, the mean of those that show least: those nearest to the median of all,
    and with the mouth shut as most have it."""
    points = expression_points(front)
    off = ((points - np.median(points, axis=0)) ** 2).sum(axis=(1, 2))
    order = np.argsort(off + np.asarray(mouth_opening(front)) ** 2)
    return np.asarray(front[order[: max(int(NEUTRAL_SHARE * len(front)), 1)]].mean(axis=0), np.float64)
