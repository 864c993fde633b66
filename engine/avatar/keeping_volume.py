"""The avatar on half joints: shoulders, elbows and knees that stay round where the avatar bends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.avatar.registration.rigging import Pose, unposed
from engine.geometry.rigging.half_joints import is_half_joint, with_half_joints
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms


def keeping_volume(mesh: SkinnedMesh, filmed: Clip) -> tuple[SkinnedMesh, Clip]:
    """A mesh with half joints (`engine.geometry.rigging.half_joints`), and the clip of one frame of how the person was `filmed`
    for it. So posed all is where it was; the T-pose is what half joints make of that."""
    held = with_half_joints(mesh)
    added = len(held.skeleton.names) - len(mesh.skeleton.names)
    still = rotation.identity(1, added).astype(np.float32)
    clip = replace(filmed, rotations=np.concatenate([filmed.rotations, still], 1))
    seen = skin(
        mesh.vertices, mesh.bones, mesh.weights, pose_transforms(mesh.skeleton, filmed.rotations, filmed.root)[0]
    )
    transforms = pose_transforms(held.skeleton, clip.rotations, clip.root)[0].astype(np.float64)
    joints = np.einsum("jab,jb->ja", transforms[:, :3, :3], held.skeleton.heads) + transforms[:, :3, 3]
    rest = unposed(seen, held.bones, held.weights, Pose(joints, transforms[:, :3, :3]), held.skeleton.heads)
    half = np.array([is_half_joint(name) for name in held.skeleton.names])
    bent = np.asarray(half[held.bones] & (held.weights > 0)).any(1)
    vertices = np.where(bent.reshape(-1, 1), rest, mesh.vertices).astype(np.float32)
    return replace(held, vertices=vertices), clip
