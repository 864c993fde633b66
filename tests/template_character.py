"""A character made of the template alone: its skin in T-pose with a checker for a texture, and a made-up walk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body import load_template
from engine.body.subdivision import catmull_clark
from engine.body.template import load_rig
from engine.geometry.mesh.surface import triangulate
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import bone_transforms, skin
from engine.motion.clip import Clip


def template_character(subdivided: bool = False, texture_size: int = 512) -> SkinnedMesh:
    """The template's skin, 26,756 triangles (four times as many when subdivided), feet on the ground, arms out."""
    template, rig = load_template(), load_rig("mixamo")
    heads, _ = rig.joints(template.vertices)
    turns = np.tile(np.eye(3), (len(rig.names), 1, 1))
    for side, out in (("Left", 1.0), ("Right", -1.0)):
        arm = heads[rig.index(f"{side}Hand")] - heads[rig.index(f"{side}Arm")]
        turns[rig.index(f"{side}Arm")] = Rotation.align_vectors([[out, 0, 0]], [arm])[0].as_matrix()
    transforms = bone_transforms(rig.parents, heads, turns)
    rest = skin(template.vertices, rig.bones, rig.weights, transforms)
    joints = np.einsum("bij,bj->bi", transforms[:, :3, :3], heads) + transforms[:, :3, 3]
    quads = template.quads[slice(*template.parts["body"])]
    uv_quads, uv = template.uv_quads[slice(*template.parts["body"])], template.uv
    weights = weight_table(rig.bones, rig.weights, len(rig.names))
    if subdivided:
        step, flat = catmull_clark(quads, len(rest)), catmull_clark(uv_quads, len(uv), smooth=False)
        rest, weights, quads = step.points @ rest, step.points @ weights, step.quads
        uv, uv_quads = flat.points @ uv, flat.quads
    corners = np.stack([triangulate(quads), triangulate(uv_quads)], 2).reshape(-1, 2)
    pairs, index = np.unique(corners, axis=0, return_inverse=True)
    floor = rest[np.unique(quads), 1].min()
    used = weights[pairs[:, 0]]
    bones = np.argsort(-used, axis=1)[:, :4]
    strengths = np.take_along_axis(used, bones, 1)
    bones[strengths == 0] = 0
    return SkinnedMesh(
        skeleton=Skeleton(rig.names, rig.parents, (joints - [0, floor, 0]).astype(np.float32)),
        vertices=(rest[pairs[:, 0]] - [0, floor, 0]).astype(np.float32),
        triangles=index.reshape(-1, 3).astype(np.int32),
        uv=uv[pairs[:, 1]].astype(np.float32),
        bones=bones.astype(np.uint8),
        weights=(strengths / strengths.sum(1, keepdims=True)).astype(np.float32),
        texture=checker(texture_size),
    )


def weight_table(bones: NDArray, weights: NDArray, count: int) -> NDArray[np.float64]:
    """Influences as a full (V, B) table."""
    table = np.zeros((len(bones), count))
    np.add.at(table, (np.arange(len(bones))[:, None], bones), weights)
    return table


def checker(size: int) -> NDArray[np.uint8]:
    """Squares in warm colours that change over the texture, so that a wrong turn of it shows."""
    y, x = np.mgrid[:size, :size]
    light = np.where((x * 32 // size + y * 32 // size) % 2, 1.0, 0.7)
    colour = np.stack([np.full((size, size), 220.0), 120 + 100 * x / size, 90 + 120 * y / size], 2)
    return (light[..., None] * colour).astype(np.uint8)


def walk(skeleton: Skeleton, frames: int = 30, fps: float = 30.0, travels: bool = True) -> Clip:
    """A loop of one double step, crude but with every limb in motion and the arms down."""
    phase = 2 * np.pi * np.arange(frames) / frames
    rotations = np.zeros((frames, len(skeleton.names), 4), np.float32)
    rotations[..., 3] = 1
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        swing = sign * np.sin(phase)
        turns = {
            f"{side}UpLeg": Rotation.from_euler("x", -0.5 * swing[:, None]),
            f"{side}Leg": Rotation.from_euler("x", 0.5 - 0.4 * np.cos(phase + sign)[:, None]),
            f"{side}Arm": Rotation.from_euler("x", 0.5 * swing[:, None]) * Rotation.from_euler("z", -1.25 * sign),
            f"{side}ForeArm": Rotation.from_euler("y", np.full((frames, 1), -0.4 * sign)),
        }
        for name, turn in turns.items():
            rotations[:, skeleton.index(name)] = turn.as_quat()
    root = np.tile(skeleton.heads[0], (frames, 1))
    root[:, 1] += 0.02 * np.cos(2 * phase) - 0.03
    if travels:
        root[:, 2] += 1.2 * np.arange(frames) / frames
    return Clip("walk" if travels else "walk_in_place", fps, rotations, root.astype(np.float32), loops=True)


def still(skeleton: Skeleton, name: str = "pictured") -> Clip:
    """One frame: the arms down, the head turned."""
    rotations = np.zeros((1, len(skeleton.names), 4), np.float32)
    rotations[..., 3] = 1
    rotations[:, skeleton.index("LeftArm")] = Rotation.from_euler("z", -1.2).as_quat()
    rotations[:, skeleton.index("RightArm")] = Rotation.from_euler("z", 1.0).as_quat()
    rotations[:, skeleton.index("Head")] = Rotation.from_euler("y", 0.4).as_quat()
    return Clip(name, 30.0, rotations, skeleton.heads[:1].copy())
