"""Where the head is in a picture, by the places of a face's points in it alone: a scaled orthographic camera."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.scaled_orthographic import scaled_orthographic
from engine.perception.face.landmarks import RIGID_VERTICES


def skull_camera(
    front: NDArray[np.floating], places: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A matrix (2, 3), rows of one length at right angles, and a shift (2,) that carry a face `front` (478, 3) to its
    `places` (478, 2). They are those of the skull: of vertices that expressions hardly move."""
    chosen = list(RIGID_VERTICES)
    return scaled_orthographic(front[chosen], places[chosen, :2])
