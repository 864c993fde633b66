"""Landmarks of a person in space."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.registration.rigid import Similarity
from engine.geometry.rigging.joint_names import SIDE_NAMES

FACE_LANDMARKS = 68
"""Points of a face (iBUG)."""
HAND_LANDMARKS = 21
"""Points of a hand (`engine.perception.pose.hands.HAND_JOINTS`)."""
LID_POINT_COUNT, EYE_POINT_COUNT = 16, 21
"""Points of an eye between its lids, from the outer corner over the upper lid; and all with those of its iris, the
middle first."""


@dataclass(frozen=True)
class SpatialLandmarks:
    """Where landmarks are, metres, in the world of the cloud.

    body : places (3,) by the names of `engine.body.landmarks.landmark_model`; those not found are left out.
    face : (68, 3) NaN where a point is not known.
    hands : (2, 21, 3) of the person's own left and right hand; NaN where a point is not known.
    eyes : (2, 21, 3) of the person's own left and right eye; NaN where a point is not known.
    """

    body: Mapping[str, NDArray[np.float64]]
    face: NDArray[np.float64] = field(default_factory=lambda: np.full((FACE_LANDMARKS, 3), np.nan))
    hands: NDArray[np.float64] = field(default_factory=lambda: np.full((len(SIDE_NAMES), HAND_LANDMARKS, 3), np.nan))
    eyes: NDArray[np.float64] = field(default_factory=lambda: np.full((len(SIDE_NAMES), EYE_POINT_COUNT, 3), np.nan))

    def without(self, names: frozenset[str]) -> SpatialLandmarks:
        """Those of the body whose names are not among `names`, and all of the face."""
        return replace(self, body={name: at for name, at in self.body.items() if name not in names})

    def moved(self, change: Similarity) -> SpatialLandmarks:
        """These landmarks carried into another world."""
        body = {name: change(at) for name, at in self.body.items()}
        return SpatialLandmarks(body, change(self.face), change(self.hands), change(self.eyes))
