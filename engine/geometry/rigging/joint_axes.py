"""The axes that Mixamo's and Ready Player Me's skeletons give their joints, in T-pose.

Motions and poses that were made for such skeletons say how a joint is turned within its parent: they fit a skeleton of the
same names only if its joints have the same axes. Each joint's y axis leads along its bone; its x axis is the hinge by which
fingers and knees bend. There is no document of them: they are what the rigs have that these services hand out.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import FINGER_NAMES
from engine.geometry.rigging.skeleton import Skeleton

FOOT_SLOPE = (0.0, -0.6, 0.8)
"""Where a foot's bone points that stands flat: from the ankle to the ball, between 35 and 40 degrees down."""

LIMB_AXES = {
    "Shoulder": ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)),
    "Arm": ("ForeArm", (0.0, -1.0, 0.0)),
    "ForeArm": ("Hand", (0.0, -1.0, 0.0)),
    "UpLeg": ("Leg", (0.0, 0.0, 1.0)),
    "Leg": ("Foot", (0.0, 0.0, 1.0)),
    "Foot": (FOOT_SLOPE, (0.0, 1.0, 0.0)),
    "ToeBase": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
}
"""Of the left side's joints: where y points in the world, or the joint that it leads to; and whereto z leans. Shoulders and feet
have the same axes in everybody, wherever their ends are: poses would lift them otherwise."""


def mixamo_axes(skeleton: Skeleton) -> NDArray[np.float64]:
    """The axes of each joint in T-pose, (J, 3, 3): column k is where the joint's axis k points in the world.

    Trunk, head and face, and joints of other names, have the world's. Arms and legs have those of `LIMB_AXES`, mirrored on
    the right; a hand's z axis leaves its palm, as that of each finger does, whose y axis leads to its next joint.
    """
    axes = np.tile(np.eye(3), (len(skeleton.names), 1, 1))
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        for limb, (along, aside) in LIMB_AXES.items():
            if side + limb not in skeleton.names:
                continue
            fixed = isinstance(along, tuple)
            leads = np.array([sign, 1.0, 1.0]) * along if fixed else _way(skeleton, side + limb, f"{side}{along}")
            if leads is not None:
                axes[skeleton.index(side + limb)] = _frame(leads, np.array(aside))
        if f"{side}Hand" in skeleton.names:
            _set_hand(axes, skeleton, side, sign)
    return axes


def _set_hand(axes: NDArray[np.float64], skeleton: Skeleton, side: str, sign: float) -> None:
    """The axes of a hand and its fingers."""
    outward, palm = np.array([sign, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])
    ahead = _way(skeleton, f"{side}Hand", f"{side}HandMiddle1")
    outward = outward if ahead is None else ahead
    across = _way(skeleton, f"{side}HandIndex1", f"{side}HandPinky1")
    if across is not None:
        palm = sign * np.cross(across, outward)
    axes[skeleton.index(f"{side}Hand")] = _frame(outward, palm)
    for finger in FINGER_NAMES:
        along = outward
        for number in (1, 2, 3):
            joint = f"{side}Hand{finger}{number}"
            if joint not in skeleton.names:
                break
            further = _way(skeleton, joint, f"{side}Hand{finger}{number + 1}")
            along = along if further is None else further  # the last one continues its finger
            axes[skeleton.index(joint)] = _frame(along, palm)


def _way(skeleton: Skeleton, start: str, end: str) -> NDArray[np.float64] | None:
    """From one joint to another, (3,) metres; None where the skeleton lacks one."""
    if start not in skeleton.names or end not in skeleton.names:
        return None
    return (skeleton.heads[skeleton.index(end)] - skeleton.heads[skeleton.index(start)]).astype(np.float64)


def _frame(along: NDArray[np.floating], aside: NDArray[np.floating]) -> NDArray[np.float64]:
    """The axes (3, 3) of which y points `along`, and z lies as near `aside` as that allows."""
    y = along / np.linalg.norm(along)
    z = aside - (aside @ y) * y
    z /= np.linalg.norm(z)
    return np.stack([np.cross(y, z), y, z], axis=1)
