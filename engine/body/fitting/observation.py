"""What is known of a person from one view: what `engine.body.fitting.body_fitting` fits the template to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.fitting.contour import Contour
from engine.geometry.camera import Camera
from engine.geometry.rigging.joint_names import SIDE_NAMES

DIRECTED_LIMBS = (
    *((f"{side}{a}", f"{side}{b}") for side in SIDE_NAMES for a, b in (("Arm", "ForeArm"), ("ForeArm", "Hand"))),
    *((f"{side}{a}", f"{side}{b}") for side in SIDE_NAMES for a, b in (("UpLeg", "Leg"), ("Leg", "Foot"))),
)
"""Limbs whose direction in space is believed, as joints."""

LANDMARK_SIGMA_SHARE = 0.012
"""How far perception's landmarks are off, usually, as a share of the body's height in the picture."""


@dataclass(frozen=True)
class Crossing:
    """One forearm before the other.

    front : the side of the one before, 0 left, 1 right.
    front_at, back_at : how far along from the elbow the place is at which both are seen, as shares of the forearms.
    tucked_at : how far along from the shoulder the other's hand is behind the front side's upper arm, too; None where it
        is not.
    """

    front: int
    front_at: float
    back_at: float
    tucked_at: float | None = None


@dataclass(frozen=True)
class Observation:
    """A person as one camera sees them.

    points : (L, 2) pixels of the landmarks of `engine.body.landmarks`.
    confidence : (L,) in [0, 1]: how much each is believed; what is not seen has none.
    directions : (M, 3) unit vectors of `DIRECTED_LIMBS` in the camera's axes: x right, y up, z to the viewer.
    direction_confidence : (M,) in [0, 1].
    camera : in the world in which the person is fitted.
    landmark_sigma : how far the points are off, usually, as a share of the body's height in the picture.
    crossing : of the forearms, if they cross.
    contour : of the person's mask, where there is one.
    """

    points: NDArray[np.float32]
    confidence: NDArray[np.float32]
    directions: NDArray[np.float32]
    direction_confidence: NDArray[np.float32]
    camera: Camera
    landmark_sigma: float = LANDMARK_SIGMA_SHARE
    crossing: Crossing | None = None
    contour: Contour | None = None

    @property
    def height(self) -> float:
        """Pixels from the highest to the lowest landmark that is seen."""
        return max(float(np.ptp(self.points[self.confidence > 0.3, 1], axis=0)), 1.0)
