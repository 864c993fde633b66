"""Where the head is in a picture, by the places of a face's points in it alone: a scaled orthographic camera."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import RIGID_VERTICES


def skull_camera(
    front: NDArray[np.floating], places: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A matrix (2, 3), rows of one length at right angles, and a shift (2,) that carry a face `front` (478, 3) to its
    `places` (478, 2). They are those of the skull: of vertices that expressions hardly move."""
    chosen = list(RIGID_VERTICES)
    model, seen = np.asarray(front, np.float64)[chosen], np.asarray(places, np.float64)[chosen, :2]
    middle, at = model.mean(axis=0), seen.mean(axis=0)
    affine = np.linalg.lstsq(model - middle, seen - at, rcond=None)[0].T
    left, lengths, right = np.linalg.svd(affine, full_matrices=False)
    matrix = float(lengths.mean()) * left @ right
    return matrix, at - matrix @ middle
