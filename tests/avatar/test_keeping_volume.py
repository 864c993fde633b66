"""Half joints of an avatar: as it was filmed it stays, and raised shoulders keep more of their volume."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.avatar.acting import FILMED_CLIP_NAME
from engine.avatar.keeping_volume import keeping_volume
from engine.avatar.mesh import skinned_mesh, surface_of
from engine.body.rest_pose import t_pose
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import skin
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.kinematics import pose_transforms


@pytest.fixture(scope="module")
def mesh() -> SkinnedMesh:
    template, rig = load_template(), load_rig(HUMAN_RIG)
    skeleton, _, vertices = t_pose(rig, template.vertices, template.vertices_of("body"))
    return skinned_mesh(surface_of(template), rig, skeleton, vertices, np.zeros((8, 8, 3), np.uint8))


def lowered(mesh: SkinnedMesh, degrees: float) -> Clip:
    """The arms so far below the horizontal."""
    turns = rotation.identity(1, len(mesh.skeleton.names))
    for side, name in ((-1, "LeftArm"), (1, "RightArm")):
        turns[0, mesh.skeleton.index(name)] = rotation.about("z", side * np.radians(degrees))
    return Clip(FILMED_CLIP_NAME, 30.0, turns.astype(np.float32), mesh.skeleton.heads[:1])


def posed(mesh: SkinnedMesh, clip: Clip) -> np.ndarray:
    return skin(
        mesh.vertices,
        mesh.bones,
        mesh.weights,
        pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0],
    )


def narrowest(mesh: SkinnedMesh, clip: Clip) -> float:
    """How thick the skin's blend of turns leaves what is thickest squeezed."""
    turns = pose_transforms(mesh.skeleton, clip.rotations, clip.root)[0][:, :3, :3]
    blended = np.einsum("vk,vkij->vij", mesh.weights, turns[mesh.bones])
    return float(np.linalg.svd(blended, compute_uv=False).min())


def test_as_it_was_filmed_it_stays(mesh: SkinnedMesh) -> None:
    filmed = lowered(mesh, 45)
    held, clip = keeping_volume(mesh, filmed)
    apart = np.linalg.norm(posed(held, clip) - posed(mesh, filmed), axis=1)
    assert apart.max() < 1e-4


@pytest.mark.parametrize(("degrees", "twist"), [(-75, 0), (-75, 100), (80, 0), (0, 120)])
def test_shoulders_are_not_squeezed_where_arms_are_raised_or_turned(
    mesh: SkinnedMesh, degrees: float, twist: float
) -> None:
    """Two joints as far apart as these leave the cosine of half of that, a joint between them that of a quarter."""
    clip = lowered(mesh, degrees)
    held, _ = keeping_volume(mesh, clip)
    for name in ("LeftArm", "RightArm"):
        joint = mesh.skeleton.index(name)
        clip.rotations[0, joint] = rotation.multiply(clip.rotations[0, joint], rotation.about("x", np.radians(twist)))
    more = rotation.identity(1, len(held.skeleton.names) - len(mesh.skeleton.names))
    clip_held = replace(clip, rotations=np.concatenate([clip.rotations, more], 1))
    farthest = max(np.radians(abs(degrees)), np.radians(twist))
    assert narrowest(mesh, clip) < np.cos(farthest / 2) + 0.03
    assert narrowest(held, clip_held) > np.cos(farthest / 4) - 0.06
