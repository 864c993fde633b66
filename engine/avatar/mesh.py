"""The avatar as engines get it: the template's visible parts as one skinned mesh with one texture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.avatar.eye_charts import avatar_uv
from engine.avatar.registration.rigging import Pose, unposed
from engine.avatar.worn import Attachments
from engine.body.rig import Rig
from engine.body.template import Template
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.morph_target import MorphTarget, morph_target
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES

AVATAR_PARTS = ("body", "left_eye", "right_eye", "upper_teeth", "lower_teeth", "tongue")
"""The template's parts that an avatar has. Lashes are left out: as bare strips, without alpha, they are fins."""

EYE_JOINTS = {"LeftEye": "left_eye", "RightEye": "right_eye"}
"""The joint of each eyeball and the part of the template that it is. An eyeball is rigid, which its weights in the source are
not to the last percent."""


@dataclass(frozen=True)
class Surface:
    """The triangles of `AVATAR_PARTS`, with vertices along seams of the texture once for each side.

    vertex_of : (N,) int, which of the template's vertices each of these is.
    uv : (N, 2) float32 in [0, 1], (0, 0) at the texture's upper left corner.
    triangles : (T, 3) int32 into these vertices, counter-clockwise seen from outside.
    eyes : of each joint in `EYE_JOINTS`, the vertices of the eyeball that turns with it.
    """

    vertex_of: NDArray[np.intp]
    uv: NDArray[np.float32]
    triangles: NDArray[np.int32]
    eyes: Mapping[str, NDArray[np.intp]]


def surface_of(template: Template) -> Surface:
    """The surface of an avatar, which is the same for everybody."""
    faces = template.faces(*AVATAR_PARTS)
    corners = np.stack([triangulate(template.quads[faces]), triangulate(template.uv_quads[faces])], 2).reshape(-1, 2)
    pairs, index = np.unique(corners, axis=0, return_inverse=True)
    vertex_of = pairs[:, 0].astype(np.intp)
    return Surface(
        vertex_of=vertex_of,
        uv=avatar_uv(template)[pairs[:, 1]],
        triangles=index.reshape(-1, 3).astype(np.int32),
        eyes={
            joint: np.flatnonzero(np.isin(vertex_of, template.vertices_of(part))) for joint, part in EYE_JOINTS.items()
        },
    )


def skinned_mesh(
    surface: Surface,
    rig: Rig,
    skeleton: Skeleton,
    vertices: NDArray[np.floating],
    texture: NDArray[np.uint8],
) -> SkinnedMesh:
    """The mesh of a person: the template's `vertices` (V, 3) in T-pose, metres, on the joints of `skeleton`, which are
    those of `rig` in its order; `texture` (H, W, 3) uint8 sRGB.

    Raises ValueError where skeleton and rig have other joints.
    """
    if skeleton.names != rig.names:
        raise ValueError("the skeleton has other joints than the rig")
    bones, weights = _strongest(rig.bones[surface.vertex_of], rig.weights[surface.vertex_of])
    for joint, eyeball in surface.eyes.items():
        bones[eyeball], weights[eyeball] = [rig.index(joint), 0, 0, 0], [1, 0, 0, 0]
    return SkinnedMesh(
        skeleton=skeleton,
        vertices=np.asarray(vertices[surface.vertex_of], np.float32),
        triangles=surface.triangles,
        uv=surface.uv,
        bones=bones,
        weights=weights,
        texture=texture,
    )


def wearing(mesh: SkinnedMesh, worn: Attachments, pose: Pose) -> SkinnedMesh:
    """The mesh with what stands off the body behind its own vertices and triangles, brought from the `pose` in which the person
    was filmed to T-pose."""
    if not len(worn.triangles):
        return mesh
    corners, index = np.unique(
        np.stack([worn.triangles, worn.atlas.corners], 2).reshape(-1, 2), axis=0, return_inverse=True
    )
    of, place = corners.T
    rest = unposed(worn.vertices, worn.bones, worn.weights, pose, mesh.skeleton.heads)
    return SkinnedMesh(
        skeleton=mesh.skeleton,
        vertices=np.concatenate([mesh.vertices, rest[of].astype(np.float32)]),
        triangles=np.concatenate([mesh.triangles, (index.reshape(-1, 3) + len(mesh.vertices)).astype(np.int32)]),
        uv=np.concatenate([mesh.uv, worn.atlas.uv[place]]),
        bones=np.concatenate([mesh.bones, worn.bones[of]]),
        weights=np.concatenate([mesh.weights, worn.weights[of]]),
        texture=mesh.texture,
    )


def morphs_of(surface: Surface, displacements: Mapping[str, NDArray[np.floating]]) -> tuple[MorphTarget, ...]:
    """Morph targets of the mesh from displacements (V, 3) of the template's vertices in T-pose, metres, by their names."""
    return tuple(morph_target(name, moved[surface.vertex_of]) for name, moved in displacements.items())


def _strongest(bones: NDArray[np.uint8], weights: NDArray[np.float32]) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """The `MAX_VERTEX_INFLUENCES` strongest of each vertex' influences (N, K), which stand strongest first, summing to
    one."""
    kept = np.zeros((len(bones), MAX_VERTEX_INFLUENCES), np.float32)
    width = min(MAX_VERTEX_INFLUENCES, weights.shape[1])
    kept[:, :width] = weights[:, :width]
    joints = np.zeros((len(bones), MAX_VERTEX_INFLUENCES), np.uint8)
    joints[:, :width] = np.where(kept[:, :width] > 0, bones[:, :width], 0)
    return joints, kept / kept.sum(1, keepdims=True)
