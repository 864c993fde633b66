"""The aligning transformation phi between the driver's neutral frame and the target."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity, fit_similarity
from engine.perception.face.landmarks import EYES_AND_NOSE_TIP


def align(neutral: NDArray[np.floating], target: NDArray[np.floating]) -> Similarity:
    """phi: from the driver's neutral mesh to the target's, over the eyes and the nose tip (section 4).

    Parameters
    ----------
    neutral, target : (478, 2 or 3) meshes in pixels.
    """
    chosen = list(EYES_AND_NOSE_TIP)
    return fit_similarity(neutral[chosen, :2].astype(float), target[chosen, :2].astype(float))
