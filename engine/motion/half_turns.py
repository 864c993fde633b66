"""How joints between joints turn (`engine.geometry.rigging.half_joints`)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from engine.geometry.rigging.half_joints import BACK_SUFFIX, HALF_SUFFIX, HALVED_JOINTS, SWING_SUFFIX, TWIST_SUFFIX
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation

Array = NDArray[np.float64]


def with_half_turns(skeleton: Skeleton, rotations: ArrayLike) -> Array:
    """Rotations (..., J, 4) of joints in their parents' axes, in which joints between joints turn as the others have them turn,
    whatever was said of them."""
    turned = np.array(rotations, np.float64)
    for name, end in HALVED_JOINTS.items():
        if name + HALF_SUFFIX not in skeleton.names:
            continue
        joint = skeleton.index(name)
        whole = turned[..., joint, :].copy()
        bone = skeleton.heads[skeleton.index(end)] - skeleton.heads[joint]
        swung = swing(whole, bone)
        half = rotation.slerp(rotation.identity(), swung, 0.5)
        twisted = rotation.multiply(swung, half_twist(rotation.multiply(rotation.inverse(swung), whole), bone))
        turned[..., skeleton.index(name + HALF_SUFFIX), :] = half
        for suffix, wanted in ((BACK_SUFFIX, half), (SWING_SUFFIX, swung), (TWIST_SUFFIX, twisted)):
            turned[..., skeleton.index(name + suffix), :] = rotation.multiply(rotation.inverse(whole), wanted)
    return turned


def swing(rotations: ArrayLike, bone: ArrayLike) -> Array:
    """Rotations (..., 4) of a `bone` (3,) without what they turn it about itself: the shortest to where they point it."""
    along = rotation.normalize(bone)
    return rotation.between(along, rotation.rotate(rotations, along))


def half_twist(twists: ArrayLike, bone: ArrayLike) -> Array:
    """Half of turns (..., 4) of a `bone` (3,) about itself.

    Half a turn either way is the same, its halves are not: from three eighths of a turn on, which is as far as arms turn,
    the half grows smaller again, so that no skin jumps.
    """
    turns, along = np.asarray(twists, np.float64), rotation.normalize(bone)
    angle = 2 * np.arctan2(turns[..., :3] @ along, turns[..., 3])
    angle = (angle + np.pi) % (2 * np.pi) - np.pi
    return rotation.about(along, np.sign(angle) * np.minimum(np.abs(angle), 3 * (np.pi - np.abs(angle))) / 2)
