"""A driver's average face, of its own video: the frames that show much the same as the one that is chosen to be at rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.persona.texture.expression_weights import expression_points

SAME_EXPRESSION_EYE_DISTANCES = 0.02
"""Eye distances that points of two frames are apart, in the mean square's root, in which the face does the same: a tracker's noise is half of it."""


def rest_of_frames(front: NDArray[np.floating], chosen: int) -> NDArray[np.float64]:
    """(478, 3) the mean of those of the frames `front` (F, 478, 3), turned to the front, in eye distances, whose expression is that of the
    frame `chosen`.

    One frame is a hundredth of the eye distance from the mean of those like it, and gives this to every frame of the film; two means of half
    of them each are 0.002 apart.
    """
    points = expression_points(front)
    apart = np.sqrt(((points - points[chosen]) ** 2).sum(axis=-1).mean(axis=1))
    return np.asarray(front[apart <= SAME_EXPRESSION_EYE_DISTANCES].mean(axis=0), np.float64)
