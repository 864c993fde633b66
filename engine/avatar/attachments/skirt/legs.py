"""Where the legs of a fitted skin are, around which something may hang."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.registration.models import HumanModels
from engine.geometry.rigging.joint_names import SIDE_NAMES, Side

LEG_BONES = ("UpLeg", "Leg")
"""The bones of a leg without its foot."""
MIDDLE_METRES = 0.004
"""Metres from the middle of the template up to which its skin is on its middle line."""
AXIS_WINDOW_METRES = 0.15
"""Metres below the crotch down to which both legs tell where the axis between them is."""


@dataclass(frozen=True)
class Legs:
    """Both legs of somebody who stands.

    skin : of each side in `SIDE_NAMES`, (S,) bool, the skin's vertices of that leg and of that half of the hips.
    crotch : height, metres.
    soles : height, metres.
    axis : (2,) x and z of the middle between both, metres.
    left : (2,) along x and z, a unit vector towards the left leg.
    apart : metres between the middles of both.
    """

    skin: dict[Side, NDArray[np.bool_]]
    crotch: float
    soles: float
    axis: NDArray[np.float64]
    left: NDArray[np.float64]
    apart: float

    def sideways(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(N,) how far points (N, 3) are to the left of the axis: 1 at the middle of the left leg, -1 at that of the right one."""
        return np.asarray((points[:, [0, 2]] - self.axis) @ self.left / (self.apart / 2))


def legs_of(human: HumanModels, vertices: NDArray[np.floating]) -> Legs:
    """The legs of a person whose skin's vertices are (S, 3), metres, y up."""
    skin, rig = human.skin, human.rig
    rest = human.space.mean[skin.vertices]
    strongest = skin.bones[:, 0]
    hips = strongest == rig.index("Hips")
    below_waist = hips | np.isin(strongest, [rig.index(f"{side}{bone}") for side in SIDE_NAMES for bone in LEG_BONES])
    middle = below_waist & (np.abs(rest[:, 0]) < MIDDLE_METRES)
    crotch = float(vertices[middle, 1].min())
    sides: dict[Side, NDArray[np.bool_]] = {}
    means = []
    near = (vertices[:, 1] < crotch) & (vertices[:, 1] > crotch - AXIS_WINDOW_METRES)
    for side, sign in zip(SIDE_NAMES, (1, -1), strict=True):
        own = np.isin(strongest, [rig.index(f"{side}{bone}") for bone in LEG_BONES])
        sides[side] = own | (hips & (sign * rest[:, 0] >= 0))
        means.append(vertices[own & near][:, [0, 2]].mean(0))
    between = means[0] - means[1]
    apart = float(np.linalg.norm(between))
    soles = float(vertices[skin.regions["feet"], 1].min())
    return Legs(sides, crotch, soles, (means[0] + means[1]) / 2, between / apart, apart)
