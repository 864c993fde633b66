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


def from_before(
    front: NDArray[np.floating], face: NDArray[np.floating], matrix: NDArray[np.floating], shift: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(478, 2) where the points of a `face` (478, 2 or 3) are from before, in eye distances, by its `skull_camera`; as deep as those of `front` (478, 3)."""
    away = np.asarray(face, np.float64)[:, :2] - shift - front[:, 2:] * matrix[:, 2]
    return np.asarray(away @ np.linalg.inv(matrix[:, :2]).T)
