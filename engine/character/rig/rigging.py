"""From a mesh in the pictured pose to a character in T-pose, and back: what binds it to its skeleton."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.body.body_space import BodySpace
from engine.character.figure.picture_space import PictureCamera
from engine.character.fit.rest_skeleton import PicturedJoints, pictured_joints
from engine.character.fit.template_fit import FittedBody
from engine.character.surface.front_and_back import ClosedMesh
from engine.character.surface.soles import with_soles
from engine.geometry.mesh.welding import same_rows
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.motion.clip import Clip

MIN_VOLUME_RATIO, TARGET_VOLUME_RATIO = 0.35, 0.6
"""What blending turns may leave of a volume. Where the blend leaves less halfway between a vertex's two strongest
joints, as in a sharply bent elbow, the way back to T-pose is no longer one. There the vertex goes with the strongest,
as much more as it takes to keep the second."""
VOLUME_BISECTION_STEPS = 7
"""Of the share that is asked for how much more."""


@dataclass(frozen=True)
class Character:
    """A character and how it stands in its picture: `pictured`, a clip of one frame. The picture's camera stands at
    `eye` (3,) in the character's world, in which the ground is y = 0."""

    mesh: SkinnedMesh
    pictured: Clip
    eye: NDArray[np.float64]


def bind(
    mesh: ClosedMesh,
    mask: NDArray[np.bool_],
    camera: PictureCamera,
    fitted: FittedBody,
    space: BodySpace,
    texture: NDArray[np.uint8],
    uv: NDArray[np.float32],
) -> Character:
    """Bind a mesh in picture space, made of a person's `mask` (h, w), to the fitted skeleton, in T-pose.

    Posed by `Character.pictured` the vertices are where they were: linear blend skinning by the same weights is inverted
    for each vertex. Only undersides of feet, which the picture does not show, come to lie flat.
    """
    seen = camera.to_metres(mesh.vertices)
    eye = np.array([0.0, -seen[:, 1].min(), camera.distance])
    posed = seen + eye
    bones = mesh.bones.astype(np.intp)
    joints = pictured_joints(fitted, space).seen_from(eye)
    transforms = joints.transforms()
    vertices, weights, blended = at_rest(posed, bones, mesh.weights, transforms)

    def covered(which: NDArray[np.intp], places: NDArray[np.float64]) -> NDArray[np.bool_]:
        back = np.einsum("vij,vj->vi", blended[which, :3, :3], places) + blended[which, :3, 3]
        x, y = np.rint(camera.to_picture(back - eye)[:, :2]).astype(int).T
        inside = (x >= 0) & (y >= 0) & (x < mask.shape[1]) & (y < mask.shape[0])
        return inside & mask[np.where(inside, y, 0), np.where(inside, x, 0)]

    point = same_rows(
        mesh.vertices
    )  # where sides are coloured as the back is, vertices of the front are there once more
    in_front = np.isin(point, point[mesh.front])
    vertices = with_soles(vertices, mesh.triangles, _feet(mesh, joints.rest.names), ~in_front & ~mesh.rim, covered)
    lift = np.array([0.0, -vertices[:, 1].min(), 0.0])
    bound = SkinnedMesh(
        joints.lifted(lift),
        (vertices + lift).astype(np.float32),
        mesh.triangles,
        uv,
        bones.astype(np.uint8),
        weights,
        texture,
    )
    return Character(bound, pictured_clip(joints), eye)


def pictured_clip(joints: PicturedJoints) -> Clip:
    """How somebody stands in their picture."""
    return Clip("pictured", 30.0, joints.rotations[None], joints.root[None])


def at_rest(
    posed: NDArray[np.float64],
    bones: NDArray[np.integer],
    weights: NDArray[np.float32],
    transforms: NDArray[np.floating],
) -> tuple[NDArray[np.float64], NDArray[np.float32], NDArray[np.float64]]:
    """The way back from a pose. Vertices (V, 3) at rest are brought to `posed` (V, 3) by the joints' transforms (J, 4,
    4) and weights (V, 4). Returns the vertices at rest, the weights, some of which are changed where there is no way
    back (`MIN_VOLUME_RATIO`), and what these blend for each vertex, (V, 4, 4)."""
    turned = transforms.astype(np.float64)
    blended = _blended(weights, turned[bones])
    halfway = _volume((turned[bones[:, 0]] + turned[bones[:, 1]]) / 2)
    least = np.where(halfway < MIN_VOLUME_RATIO, TARGET_VOLUME_RATIO, MIN_VOLUME_RATIO)
    crushed = np.flatnonzero(_volume(blended) < least)
    kept = weights.copy()
    own, mixed = turned[bones[crushed, 0]], blended[crushed]
    more, step = np.ones(len(crushed)), 0.5
    for _ in range(VOLUME_BISECTION_STEPS):
        enough = _volume(_between(mixed, own, more - step)) >= least[crushed]
        more -= np.where(enough, step, 0)
        step /= 2
    kept[crushed] *= (1 - more[:, None]).astype(np.float32)
    kept[crushed, 0] += more.astype(np.float32)
    blended[crushed] = _blended(kept[crushed], turned[bones[crushed]])
    back = np.linalg.solve(blended[:, :3, :3], (posed - blended[:, :3, 3])[..., None])[..., 0]
    return np.asarray(back), kept, blended


def _blended(weights: NDArray[np.float32], transforms: NDArray[np.float64]) -> NDArray[np.float64]:
    """What weights (V, 4) make of transforms (V, 4, 4, 4): (V, 4, 4)."""
    return np.asarray(np.einsum("vk,vkij->vij", weights.astype(np.float64), transforms))


def _volume(blended: NDArray[np.float64]) -> NDArray[np.float64]:
    """What transforms (V, 4, 4) leave of a volume, (V,)."""
    return np.asarray(np.linalg.det(blended[:, :3, :3]))


def _between(some: NDArray[np.float64], others: NDArray[np.float64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transforms (V, 4, 4) a share (V,) of the way from some to others."""
    return np.asarray(some + share[:, None, None] * (others - some))


def _feet(mesh: ClosedMesh, names: Sequence[str]) -> NDArray[np.intp]:
    """Which foot each vertex (V,) is of: 0 left, 1 right, -1 neither."""
    foot = np.full(len(mesh.vertices), -1, np.intp)
    for side, name in enumerate(("Left", "Right")):
        own = [k for k, joint in enumerate(names) if joint.startswith((f"{name}Foot", f"{name}Toe"))]
        foot[(mesh.weights * np.isin(mesh.bones, own)).sum(1) > 0.5] = side
    return foot
