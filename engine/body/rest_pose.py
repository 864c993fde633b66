"""The template in T-pose: arms stretched out along x, legs straight down, as game engines want characters bound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.rig import Rig
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinning import bone_transforms, skin

T_POSE_DIRECTIONS: dict[str, tuple[float, float, float]] = {
    **dict.fromkeys(("LeftArm", "LeftForeArm", "LeftHand"), (1.0, 0.0, 0.0)),
    **dict.fromkeys(("RightArm", "RightForeArm", "RightHand"), (-1.0, 0.0, 0.0)),
    **dict.fromkeys(("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg"), (0.0, -1.0, 0.0)),
}
"""Where bones point in T-pose. Feet stay as they stand, fingers as they are in the hand."""

WORLD_ALIGNED_BONES = ("LeftFoot", "RightFoot")
"""Bones that keep their place in the world although their parents turn."""


def t_pose(
    rig: Rig, vertices: NDArray[np.floating], standing: NDArray[np.integer]
) -> tuple[Skeleton, NDArray[np.float32], NDArray[np.float32]]:
    """The template in the shape `vertices` (V, 3), its arms anywhere, brought to T-pose by its rig.

    `standing`: the vertices of which the lowest is on the ground: the skin, without the cages around it. Returns the
    skeleton, the ends (B, 3) of its bones and the vertices (V, 3): metres, the hips above the origin.
    """
    heads, tails = rig.joints(vertices)
    rotations = np.broadcast_to(np.eye(3), (len(rig.names), 3, 3)).copy()  # of each bone in the world
    for bone, name in enumerate(rig.names):
        parent = rig.parents[bone]
        if name in T_POSE_DIRECTIONS:
            ends = _end(rig, heads, tails, bone) - heads[bone]
            rotations[bone] = shortest_rotation(ends, np.array(T_POSE_DIRECTIONS[name]))
        elif parent >= 0 and name not in WORLD_ALIGNED_BONES:
            rotations[bone] = rotations[parent]
    own = np.stack([rotations[p].T @ rotations[b] if p >= 0 else rotations[b] for b, p in enumerate(rig.parents)])
    transforms = bone_transforms(rig.parents, heads, own)
    posed = skin(vertices, rig.bones, rig.weights, transforms)
    placed = [np.einsum("bij,bj->bi", transforms[:, :3, :3], ends) + transforms[:, :3, 3] for ends in (heads, tails)]
    root = placed[0][0]
    shift = np.array([root[0], posed[standing, 1].min(), root[2]])
    skeleton = Skeleton(rig.names, rig.parents, (placed[0] - shift).astype(np.float32))
    return skeleton, (placed[1] - shift).astype(np.float32), (posed - shift).astype(np.float32)


def _end(rig: Rig, heads: NDArray[np.float32], tails: NDArray[np.float32], bone: int) -> NDArray[np.float32]:
    """Where a bone leads: to the joint that continues the limb, or to its own tail."""
    follower = {"Arm": "ForeArm", "ForeArm": "Hand", "Hand": "HandMiddle1", "UpLeg": "Leg", "Leg": "Foot"}
    name = rig.names[bone]
    side = "Left" if name.startswith("Left") else "Right"
    following = side + follower[name.removeprefix(side)]
    return heads[rig.index(following)] if following in rig.names else tails[bone]


def shortest_rotation(start: NDArray[np.floating], end: NDArray[np.floating]) -> NDArray[np.float64]:
    """The (3, 3) rotation by the smallest angle that brings the direction `start` (3,) to the direction `end` (3,)."""
    a, b = (np.asarray(v, np.float64) / np.linalg.norm(v) for v in (start, end))
    axis, cosine = np.cross(a, b), float(a @ b)
    if cosine < -1 + 1e-9:  # opposite: half a turn about anything square to it
        axis = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
        axis /= np.linalg.norm(axis)
        return 2 * np.outer(axis, axis) - np.eye(3)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + cosine))
