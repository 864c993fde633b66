"""From a drawing to a character: a cut-out of the paper, round at its edge, that its own skeleton moves."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.parts import part_of_bone
from engine.character.drawing.bone_heat import bones_nearby, heat_weights, thickness
from engine.character.drawing.flat_pose import flat_pose, flat_skeleton
from engine.character.figure.figure import Figure
from engine.character.figure.silhouette import OPAQUE_ALPHA, Silhouette
from engine.character.fit.template_fit import FittedBody, load_human
from engine.character.parts.label_map import Labels
from engine.character.rig.rigging import Character, at_rest
from engine.character.surface.front_and_back import ClosedMesh, Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface
from engine.geometry.rigging.joint_names import SIDE_NAMES
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import bone_transforms
from engine.imaging.filling.nearest import continued_colours
from engine.imaging.masks.mask_pieces import bounding_box
from engine.motion.clip import Clip

HALF_THICKNESS_SHARE, ROUNDED_EDGE_SHARE = 0.012, 0.03
"""Half a cut-out's thickness, and how far from its edge it has it, as shares of the figure's height on the grid."""
MAX_TEXTURE_TEXELS = 2048
"""Texels of the texture's longer side, at most."""
MARGIN_PIXELS = 6
"""Texels around the figure."""
LIMB_JOINTS = ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot")
DRAWING_JOINTS = (
    "Hips",
    "Spine",
    "Spine1",
    "Spine2",
    "Neck",
    "Head",
    *(f"{side}{joint}" for side in SIDE_NAMES for joint in LIMB_JOINTS),
)
"""The joints whose bones move a drawing: it has no fingers, and no toes."""


def label_drawing(figure: Figure, silhouette: Silhouette, given: NDArray[np.int8] | None = None) -> Labels:
    """Labels of a drawing on the grid: each pixel is of the part whose bone is nearest, on ways within the figure. `given` (h, w): those of a
    map of one's own, -1 where it says nothing."""
    far = bones_nearby(silhouette.mask, _bones(figure, silhouette))
    parts = np.array([part_of_bone(name) for name in DRAWING_JOINTS])
    labels = np.where(silhouette.mask, parts[far.argmin(0)], -1)
    if given is not None:
        labels = np.where(silhouette.mask & (given >= 0), given, labels)
    nothing = np.zeros(labels.shape, np.bool_)
    return Labels(labels.astype(np.int8), nothing, np.zeros(0, np.int8), nothing, np.full(labels.shape, -1, np.int8))


def close_drawing(figure: Figure, silhouette: Silhouette, labels: Labels) -> ClosedMesh:
    """The cut-out as a closed mesh on the grid. A pixel is moved by the bones of the part that its label names, and of those around."""
    mask, rig = silhouette.mask, load_human().rig
    far = bones_nearby(mask, _bones(figure, silhouette))
    parts = np.array([part_of_bone(name) for name in DRAWING_JOINTS])
    other = parts[:, None, None] != labels.labels
    allowed = np.where(other, np.inf, far)
    allowed = np.where(np.isfinite(allowed).any(0), allowed, far)
    nearest, away = allowed.argmin(0), allowed.min(0)
    weights = np.zeros((*mask.shape, len(rig.names)), np.float32)
    weights[..., [rig.index(name) for name in DRAWING_JOINTS]] = heat_weights(mask, nearest, away, len(DRAWING_JOINTS))
    rows, _ = bounding_box(mask)
    tall = rows.stop - rows.start
    half = np.where(mask, thickness(mask, HALF_THICKNESS_SHARE * tall, ROUNDED_EDGE_SHARE * tall), np.nan).astype(
        np.float32
    )
    return stitch_front_and_back([Layer(mask, Surface(half, weights), Surface(-half, weights))], silhouette.soft)


def bind_drawing(figure: Figure, silhouette: Silhouette, fitted: FittedBody, mesh: ClosedMesh) -> Character:
    """The cut-out bound to its skeleton in T-pose, textured with the picture: its back is the front seen through the paper."""
    pose = flat_pose(figure)
    camera = silhouette.camera(fitted.picture_camera())
    seen = camera.to_metres(mesh.vertices)
    ground = float(seen[:, 1].min())
    eye = np.array([0.0, -ground, camera.distance])
    rest = flat_skeleton(pose, fitted, ground)
    rest = Skeleton(rest.names, rest.parents, (rest.heads + eye).astype(np.float32))
    turns = Rotation.from_matrix(fitted.fit.rotations.astype(np.float64)).as_quat()
    root = fitted.fit.root_translation.astype(np.float64) + eye
    transforms = bone_transforms(rest.parents, rest.heads, fitted.fit.rotations, root - rest.heads[0])
    bones = mesh.bones.astype(np.intp)
    vertices, weights, _ = at_rest(seen + eye, bones, mesh.weights, transforms)
    lift = np.array([0.0, -vertices[:, 1].min(), 0.0])
    texture, uv = _texture(figure, silhouette, mesh)
    skinned = SkinnedMesh(
        Skeleton(rest.names, rest.parents, (rest.heads + lift).astype(np.float32)),
        (vertices + lift).astype(np.float32),
        mesh.triangles,
        uv,
        bones.astype(np.uint8),
        weights,
        texture,
    )
    pictured = Clip("pictured", 30.0, turns[None].astype(np.float32), root[None].astype(np.float32))
    return Character(skinned, pictured, eye)


def _bones(figure: Figure, silhouette: Silhouette) -> list[NDArray[np.float64]]:
    """The bones of `DRAWING_JOINTS` as polylines on the grid. The hips reach from leg to leg, the chest from shoulder
    to shoulder."""
    pose, rig = flat_pose(figure), load_human().rig
    ends = dict(zip(rig.names, pose.places, strict=True))
    for side in SIDE_NAMES:
        ends |= {f"{side}Tip": figure.point(f"{side}Index"), f"{side}Toe": figure.point(f"{side}FootIndex")}
    chains: dict[str, tuple[str, ...]] = {
        "Hips": ("LeftUpLeg", "Hips", "RightUpLeg"),
        "Spine": ("Hips", "Spine", "Spine1"),
        "Spine1": ("Spine1", "Spine2"),
        "Spine2": ("LeftShoulder", "Spine2", "Neck", "Spine2", "RightShoulder"),
        "Neck": ("Neck", "Head"),
    }
    for side in SIDE_NAMES:
        arm, leg = (
            (f"{side}Arm", f"{side}ForeArm", f"{side}Hand", f"{side}Tip"),
            (f"{side}UpLeg", f"{side}Leg", f"{side}Foot", f"{side}Toe"),
        )
        chains |= {joint: (joint, end) for chain in (arm, leg) for joint, end in pairwise(chain)}
    middle = figure.point("Nose").astype(np.float64)
    crown = 2 * middle - ends["Head"]
    lines = {joint: np.stack([ends[name] for name in chain]) for joint, chain in chains.items()}
    lines["Head"] = np.stack([ends["Head"], middle, crown])
    matrix = silhouette.to_grid
    return [lines[name] @ matrix[:, :2].T + matrix[:, 2] for name in DRAWING_JOINTS]


def _texture(figure: Figure, silhouette: Silhouette, mesh: ClosedMesh) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """The part of the picture that shows the figure, whose colours go on beyond its edge, and each vertex's place on it (V, 2)."""
    rows, columns = bounding_box(silhouette.alpha > 0.02, MARGIN_PIXELS)
    own = silhouette.alpha[rows, columns] > OPAQUE_ALPHA
    colours = continued_colours(np.ascontiguousarray(figure.rgb[rows, columns]), own)
    size = np.array(colours.shape[1::-1])
    matrix = np.asarray(cv2.invertAffineTransform(silhouette.to_grid))
    at = mesh.vertices[:, :2] @ matrix[:, :2].T + matrix[:, 2]
    uv = (at - [columns.start, rows.start] + 0.5) / size
    if (factor := MAX_TEXTURE_TEXELS / size.max()) < 1:
        smaller = (max(1, round(float(size[0] * factor))), max(1, round(float(size[1] * factor))))
        colours = np.asarray(cv2.resize(colours, smaller, interpolation=cv2.INTER_AREA), np.uint8)
    return colours, np.clip(uv, 0, 1).astype(np.float32)
