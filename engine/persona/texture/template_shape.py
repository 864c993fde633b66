"""The shape of the frame: the person's mean face from the front, its mouth open so far that teeth have room in the texture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.features import frontalise
from engine.perception.face.landmarks import mouth_opening

TEMPLATE_MOUTH_OPENING = 0.35
"""Of the frame's mouth, as `engine.perception.face.landmarks.mouth_opening` has it."""
MOUTH_OPENING_SIGMA = 0.03
"""By which openings are uncertain: where all mouths are as good as closed, nothing is learnt of how this one opens."""


def template_shape(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478, 3) the mean of the photographs' `meshes` (N, 478, 3) turned to the front, eye distance 1, with the mouth opened to
    `TEMPLATE_MOUTH_OPENING` as the person opens it: by the regression of all vertices on the opening."""
    front = frontalise(meshes)
    opening = np.asarray(mouth_opening(front), np.float64)
    away = opening - opening.mean()
    slope = np.einsum("n,nvc->vc", away, front) / ((away**2).sum() + len(front) * MOUTH_OPENING_SIGMA**2)
    return np.asarray(front.mean(axis=0) + (TEMPLATE_MOUTH_OPENING - opening.mean()) * slope)
