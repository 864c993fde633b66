"""The points on which feet stand: heel, ball and tip of the toes, from the skeleton at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation

Array = NDArray[np.float64]

HEEL_SHARE = 0.35
"""How far the heel lies behind the ankle, as a share of the way from ankle to ball, seen from above."""

TIP_SHARE = 0.45
"""How far the tips of the toes lie before the ball, as a share of the way from ankle to ball, seen from above."""


@dataclass(frozen=True)
class Sole:
    """One foot at rest, on the plane y = 0.

    joints : hip, knee, ankle and toe joint. The last is -1 where the skeleton has none: then the toe joint is the ball of the
        foot, and the toes are left out.
    ankle : (3,) metres, its place.
    heel : (3,) metres from the ankle.
    toe : (3,) metres from the ankle, the toe joint.
    ball : (3,) metres from the toe joint.
    tip : (3,) metres from the toe joint.
    forward : (3,) unit vector, the way the foot points, level.
    """

    joints: tuple[int, int, int, int]
    ankle: Array
    heel: Array
    toe: Array
    ball: Array
    tip: Array
    forward: Array

    @property
    def lateral(self) -> Array:
        """(3,) the axis about which the foot rolls from heel to toe: a positive turn lifts the heel."""
        return np.cross([0.0, 1.0, 0.0], self.forward)

    def points(self, ankle: Array, foot: Array, toes: Array) -> Array:
        """(..., 3, 3) heel, ball and tip, of feet at places (..., 3) and world rotations (..., 4) of foot and toes."""
        toe = ankle + rotation.rotate(foot, self.toe)
        heel = ankle + rotation.rotate(foot, self.heel)
        return np.stack([heel, toe + rotation.rotate(toes, self.ball), toe + rotation.rotate(toes, self.tip)], -2)


def soles(skeleton: Skeleton) -> tuple[Sole, Sole]:
    """The left and the right foot."""
    left, right = (_sole(skeleton, side) for side in SIDE_NAMES)
    return left, right


def leg_length(skeleton: Skeleton) -> float:
    """Thigh and shin, metres: the mean of both legs."""
    heads = np.asarray(skeleton.heads, np.float64)
    legs = [[skeleton.index(side + part) for part in ("UpLeg", "Leg", "Foot")] for side in SIDE_NAMES]
    return float(np.mean([np.linalg.norm(np.diff(heads[leg], axis=0), axis=1).sum() for leg in legs]))


def _sole(skeleton: Skeleton, side: str) -> Sole:
    heads = np.asarray(skeleton.heads, np.float64)
    hip, knee, ankle = (skeleton.index(side + part) for part in ("UpLeg", "Leg", "Foot"))
    toe = skeleton.index(f"{side}ToeBase") if f"{side}ToeBase" in skeleton.names else -1
    ground = np.array([0.0, -heads[ankle][1], 0.0])
    ahead = ground + 0.15 * np.linalg.norm(heads[hip] - heads[ankle]) * np.array([0.0, 0.0, 1.0])
    reach = heads[toe] - heads[ankle] if toe >= 0 else ahead
    level = reach * [1, 0, 1]
    under = ground - reach * [0, 1, 0]
    return Sole(
        joints=(hip, knee, ankle, toe),
        ankle=heads[ankle],
        heel=ground - HEEL_SHARE * level,
        toe=reach,
        ball=under,
        tip=under + TIP_SHARE * level * (toe >= 0),
        forward=rotation.normalize(level),
    )
