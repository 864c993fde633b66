"""Joints between joints: limbs bent and turned by linear blend skinning keep their volume.

Halfway between a bone and the bone that it hangs on, linear blend skinning takes the mean of both turns: after a right
angle a limb is 0.71 as thick, after 120 degrees half. A joint between both that turns half as far leaves 0.92 and 0.87.

It is there twice: hanging on the joint's parent it swings half as far, hanging on the joint itself half of the way back.
Both are in the same place, and where a player that knows nothing of them leaves both at rest, the skin is moved as
if neither was there. Two more hang on the joint and take back the bone's turn about itself, one all and one half of it:
the skin takes part in that turn the more, the farther along the bone it is.

Source: J. Weber, Run-time skin deformation, Game Developers Conference 2000 (bones between bones).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES

HALVED_JOINTS = {
    f"{side}{joint}": f"{side}{end}"
    for side in SIDE_NAMES
    for joint, end in (("Arm", "ForeArm"), ("ForeArm", "Hand"), ("Leg", "Foot"))
}
"""The joints that are halved, and the joint to which the bone of each leads. Those nearer the trunk come first."""
HALF_SUFFIX, BACK_SUFFIX, SWING_SUFFIX, TWIST_SUFFIX = "Half", "HalfBack", "Swing", "HalfTwist"
"""Behind a joint's name: the joint that swings half as far, the one that turns half of the way back, and those that take
back all and half of the bone's turn about itself."""
SUFFIXES = (HALF_SUFFIX, BACK_SUFFIX, SWING_SUFFIX, TWIST_SUFFIX)


def is_half_joint(name: str) -> bool:
    """Whether a joint is one of those that `with_half_joints` adds."""
    return any(name.endswith(suffix) and name.removesuffix(suffix) in HALVED_JOINTS for suffix in SUFFIXES)


def half_joint_names(names: Sequence[str]) -> tuple[str, ...]:
    """The joints that are added to a skeleton of these, in their order."""
    return tuple(name + suffix for name in HALVED_JOINTS if name in names for suffix in SUFFIXES)


def halved_skeleton(skeleton: Skeleton) -> Skeleton:
    """A skeleton with half joints behind its own."""
    added = [name for name in HALVED_JOINTS if name in skeleton.names]
    whole = np.array([skeleton.index(name) for name in added], np.intp)
    hang_on = np.stack([skeleton.parents[whole], whole, whole, whole], 1).ravel()
    return Skeleton(
        (*skeleton.names, *half_joint_names(skeleton.names)),
        np.concatenate([skeleton.parents, hang_on]).astype(np.int32),
        np.concatenate([skeleton.heads, skeleton.heads[whole.repeat(len(SUFFIXES))]]),
    )


def with_half_joints(mesh: SkinnedMesh) -> SkinnedMesh:
    """A mesh whose skeleton has half joints, which take over what its joints and those that they hang on move together. The
    vertices are where they were at rest."""
    skeleton = halved_skeleton(mesh.skeleton)
    table = np.zeros((len(mesh.vertices), len(skeleton.names)))
    np.add.at(table, (np.arange(len(table))[:, None], mesh.bones), mesh.weights)
    for name, end in HALVED_JOINTS.items():
        if name in mesh.skeleton.names:
            _halve(table, skeleton, name)
            start, bone = skeleton.heads[skeleton.index(name)], skeleton.heads[skeleton.index(end)]
            bone = bone - start
            _turn_along(table, skeleton, name, np.clip((mesh.vertices - start) @ bone / (bone @ bone), 0, 1))
    order = np.argsort(-table, axis=1, kind="stable")[:, :MAX_VERTEX_INFLUENCES]
    weights = np.take_along_axis(table, order, 1)
    return replace(
        mesh,
        skeleton=skeleton,
        bones=np.where(weights > 0, order, 0).astype(np.uint8),
        weights=(weights / weights.sum(1, keepdims=True)).astype(np.float32),
    )


def whole_joints(skeleton: Skeleton) -> NDArray[np.uint8]:
    """(J,) the joint with which each moves where half joints are at rest: those hanging on another joint with that."""
    half = np.array([is_half_joint(name) for name in skeleton.names])
    return np.where(half, skeleton.parents, np.arange(len(half))).astype(np.uint8)


def _halve(table: NDArray[np.float64], skeleton: Skeleton, name: str) -> None:
    """Give the two half joints of a joint their weights in a table (V, J): none where the joint and what hangs on it move all
    or nothing, all where they move one half."""
    below = np.zeros(len(skeleton.names), np.bool_)
    below[skeleton.index(name)] = True
    for joint, parent in enumerate(skeleton.parents):
        below[joint] |= parent >= 0 and below[parent]
    share = table[:, below].sum(1)
    half = np.minimum(share, 1 - share)
    table[:, below] *= ((share - half) / np.where(share > 0, share, 1))[:, None]
    table[:, ~below] *= ((1 - share - half) / np.where(share < 1, 1 - share, 1))[:, None]
    for suffix in (HALF_SUFFIX, BACK_SUFFIX):
        table[:, skeleton.index(name + suffix)] = half


def _turn_along(table: NDArray[np.float64], skeleton: Skeleton, name: str, along: NDArray[np.floating]) -> None:
    """Give the joints that do not turn about their bone, or half as far, what the joint itself moves in a table (V, J), the
    more the nearer to its head: `along` (V,) is 0 there, 1 at the bone's end."""
    own = table[:, skeleton.index(name)].copy()
    table[:, skeleton.index(name)] = np.maximum(2 * along - 1, 0) * own
    table[:, skeleton.index(name + TWIST_SUFFIX)] = (1 - np.abs(2 * along - 1)) * own
    table[:, skeleton.index(name + SWING_SUFFIX)] = np.maximum(1 - 2 * along, 0) * own
