"""The avatar: the fitted template as engines take it, with its expressions and the pose in which it was filmed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.acting import standing_clip
from engine.avatar.combined_targets import with_combined_targets
from engine.avatar.keeping_volume import keeping_volume
from engine.avatar.mesh import morphs_of, skinned_mesh, surface_of, wearing
from engine.avatar.registration.fitted_template import FittedTemplate
from engine.avatar.registration.rigging import Pose
from engine.avatar.worn import Attachments
from engine.body.rig import Rig
from engine.body.template import Template
from engine.geometry.rigging.morph_target import MorphTarget, morph_target
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.simplification.decimation import decimate, joint_importance
from engine.motion.clip import Clip

HEAD_VERTEX_WEIGHT = 8.0
"""How much longer the head keeps its vertices than the rest: it is looked at, and has expressions."""


@dataclass(frozen=True)
class Avatar:
    """mesh : in T-pose.
    morphs : its expressions.
    filmed : the pose in which the person stood, one frame.
    """

    mesh: SkinnedMesh
    morphs: tuple[MorphTarget, ...]
    filmed: Clip


def assemble(
    template: Template,
    rig: Rig,
    fitted: FittedTemplate,
    worn: Attachments,
    texture: NDArray[np.uint8],
    triangles: int,
) -> Avatar:
    """The avatar of a fitted template, and of what is `worn` off its body, with its texture (S, S, 3), of so many triangles at
    most. Expressions: ARKit's face units, visemes, and what talking heads ask for besides."""
    surface = surface_of(template)
    skin = skinned_mesh(surface, rig, fitted.skeleton, fitted.rest, texture)
    whole = wearing(skin, worn, Pose(fitted.joints, fitted.rotations))
    mesh, morphs = with_fewer_triangles(whole, morphs_of(surface, with_combined_targets(fitted.expressions)), triangles)
    filmed = standing_clip(mesh, fitted.rotations, fitted.joints[0], 30.0)
    mesh, filmed = keeping_volume(mesh, filmed)
    return Avatar(mesh, morphs, filmed)


def with_fewer_triangles(
    whole: SkinnedMesh, morphs: tuple[MorphTarget, ...], triangles: int
) -> tuple[SkinnedMesh, tuple[MorphTarget, ...]]:
    """A mesh of so many triangles at most, with its morph targets."""
    fewer = decimate(whole, triangles, joint_importance(whole, {"Head": HEAD_VERTEX_WEIGHT, "Jaw": HEAD_VERTEX_WEIGHT}))
    if fewer.mesh is whole:
        return whole, morphs
    count = len(whole.vertices)
    return fewer.mesh, tuple(morph_target(morph.name, morph.dense(count)[fewer.kept]) for morph in morphs)


def coarser(avatar: Avatar, levels: int) -> list[SkinnedMesh]:
    """Further levels of detail, each with a quarter of the triangles of the one before."""
    found = []
    mesh = avatar.mesh
    for _ in range(levels):
        mesh = decimate(mesh, len(mesh.triangles) // 4, joint_importance(mesh, {"Head": HEAD_VERTEX_WEIGHT})).mesh
        found.append(mesh)
    return found
