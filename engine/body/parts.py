"""Parts of the body, and which of them each vertex of the template is of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.rig import Rig
from engine.geometry.rigging.joint_names import SIDE_NAMES

BODY_PARTS = ("head", "torso", "left_arm", "right_arm", "left_leg", "right_leg")
"""Labels in order; the person's own left and right."""


def part_of_bone(name: str) -> int:
    """The label of what a joint moves, by its Mixamo name."""
    for side in SIDE_NAMES:
        rest = name.removeprefix(side)
        if rest != name and rest.startswith(("Arm", "ForeArm", "Hand")):
            return BODY_PARTS.index(f"{side.lower()}_arm")
        if rest != name and rest.startswith(("UpLeg", "Leg", "Foot", "Toe")):
            return BODY_PARTS.index(f"{side.lower()}_leg")
    return BODY_PARTS.index("head" if name.startswith(("Head", "Neck", "Jaw")) or name.endswith("Eye") else "torso")


def vertex_parts(rig: Rig) -> NDArray[np.intp]:
    """The label of each of the template's vertices (V,), by the joint that moves it most. The rig's joints have Mixamo's
    names: `engine.body.rig.HUMAN_RIG` or `mixamo`."""
    of_bone = np.array([part_of_bone(name) for name in rig.names])
    return of_bone[rig.bones[:, 0]]
