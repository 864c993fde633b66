"""An avatar read back from its own file, so that it acts anew without a capture.

Specification: Khronos, glTF 2.0, 3.7 (geometry, skins, morph targets), 3.11 (animations); what is read is what
`engine.export.gltf.glb` writes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.acting import FILMED_CLIP_NAME
from engine.avatar.avatar import Avatar
from engine.body.rig import HUMAN_RIG
from engine.body.template import FACE_UNITS, load_rig
from engine.errors import InputError
from engine.export.gltf.joints import axes_above
from engine.geometry.rigging.half_joints import half_joint_names, halved_skeleton
from engine.geometry.rigging.morph_target import MorphTarget, morph_target
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh
from engine.geometry.rigging.skinning import MAX_VERTEX_INFLUENCES
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.files.gltf_accessors import Accessors
from engine.motion.files.gltf_file import GltfFile, Part

MAX_VERTICES = 65_535
MAX_TRIANGLES = 40_000
"""More than any avatar has."""
MAX_TEXTURE_SIDE_TEXELS = 8192
MAX_MORPH_TARGETS = 200
MAX_BODY_DISTANCE_METRES = 20.0
"""Metres: nothing of a person is farther from the ground's middle."""

Array = NDArray[np.float64]


def read_avatar(path: Path) -> Avatar:
    """The avatar of an `avatar.glb`, as `engine.avatar.writing.write_avatar` left it: mesh, morph targets and the pose in which the
    person was filmed. Its texture has been through a JPEG; where it is compressed, numbers have been rounded by that.

    Raises
    ------
    InputError : `avatar_too_large`, `avatar_not_ours`.
    """
    try:
        file = GltfFile(path)
        return _avatar(file, Accessors(file))
    except InputError as refused:
        if refused.code == "motion_too_large":
            raise InputError(
                "avatar_too_large", "The avatar's GLB is larger than any that is made here: give an `avatar.glb`."
            ) from refused
        raise not_ours() from refused
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as broken:
        raise not_ours() from broken


def not_ours() -> InputError:
    return InputError(
        "avatar_not_ours", "The file is no `avatar.glb` as jobs of avatars leave it: give such a file, or the job's id."
    )


def _avatar(file: GltfFile, accessors: Accessors) -> Avatar:
    skin = file.parts["skins"][0]
    rig = load_rig(HUMAN_RIG)
    names = tuple(file.part("nodes", node).name for node in skin["joints"])
    if names not in (rig.names, rig.names + half_joint_names(rig.names)):
        raise ValueError("its joints are others")
    matrices = accessors.numbers(skin["inverseBindMatrices"]).reshape(len(names), 4, 4).swapaxes(1, 2)
    axes = matrices[:, :3, :3].swapaxes(1, 2)
    if np.abs(axes @ axes.swapaxes(1, 2) - np.eye(3)).max() > 1e-3:
        raise ValueError("joints are scaled")
    heads = _near(-np.einsum("jik,jk->ji", axes, matrices[:, :3, 3]))
    skeleton = Skeleton(rig.names, rig.parents, heads[: len(rig.names)])
    if len(names) > len(rig.names):
        skeleton = replace(halved_skeleton(skeleton), heads=heads)
    shape = file.parts["meshes"][0]
    primitive = shape["primitives"][0]
    mesh = _mesh(accessors, primitive, skeleton, _texture(file, primitive))
    morphs = _morphs(accessors, shape, len(mesh.vertices))
    return Avatar(mesh, morphs, _filmed(file, accessors, skeleton, axes))


def _mesh(
    accessors: Accessors, primitive: Mapping[str, Any], skeleton: Skeleton, texture: NDArray[np.uint8]
) -> SkinnedMesh:
    at = primitive["attributes"]
    vertices = _near(accessors.numbers(at["POSITION"]))
    count = len(vertices)
    triangles = accessors.numbers(primitive["indices"]).astype(np.int64).reshape(-1, 3)
    if count > MAX_VERTICES or len(triangles) > MAX_TRIANGLES or triangles.max() >= count or triangles.min() < 0:
        raise ValueError("its triangles are others")
    uv, bones, weights = (accessors.numbers(at[name]) for name in ("TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"))
    shapes = [uv.shape, bones.shape, weights.shape]
    if shapes != [(count, 2), (count, MAX_VERTEX_INFLUENCES), (count, MAX_VERTEX_INFLUENCES)]:
        raise ValueError("its attributes are others")
    total = weights.sum(1, keepdims=True)
    if bones.max() >= len(skeleton.names) or min(bones.min(), weights.min()) < 0 or total.min() < 0.5:
        raise ValueError("joints do not hold it")
    return SkinnedMesh(
        skeleton=skeleton,
        vertices=vertices,
        triangles=triangles.astype(np.int32),
        uv=np.clip(uv, 0, 1).astype(np.float32),
        bones=bones.astype(np.uint8),
        weights=(weights / total).astype(np.float32),
        texture=texture,
    )


def _morphs(accessors: Accessors, shape: Mapping[str, Any], count: int) -> tuple[MorphTarget, ...]:
    names, targets = shape["extras"]["targetNames"], shape["primitives"][0]["targets"]
    if not set(FACE_UNITS) <= set(names) or len(set(names)) < len(names) or len(names) > MAX_MORPH_TARGETS:
        raise ValueError("its morph targets are others")
    found = []
    for name, target in zip(names, targets, strict=True):
        offsets = _near(accessors.numbers(target["POSITION"]))
        if len(offsets) != count:
            raise ValueError("a morph target is of another mesh")
        found.append(morph_target(name, offsets))
    return tuple(found)


def _texture(file: GltfFile, primitive: Mapping[str, Any]) -> NDArray[np.uint8]:
    material = file.parts["materials"][primitive["material"]]
    texture = file.parts["textures"][material["pbrMetallicRoughness"]["baseColorTexture"]["index"]]
    data, _ = file.view(file.parts["images"][texture["source"]]["bufferView"])
    if max(_jpeg_size(bytes(data))) > MAX_TEXTURE_SIDE_TEXELS:
        raise ValueError("its texture is larger than any")
    found = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    if found is None:
        raise ValueError("its texture is no picture")
    return np.asarray(cv2.cvtColor(found, cv2.COLOR_BGR2RGB), np.uint8)


def _jpeg_size(data: bytes) -> tuple[int, int]:
    """Height and width that a JPEG's frame header claims (ISO/IEC 10918-1, B.2.2). Raises ValueError if there is none."""
    if data[:2] != b"\xff\xd8":
        raise ValueError("no JPEG")
    place = 2
    while place + 9 <= len(data) and data[place] == 0xFF:
        marker, length = data[place + 1], int.from_bytes(data[place + 2 : place + 4], "big")
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = (int.from_bytes(data[k : k + 2], "big") for k in (place + 5, place + 7))
            return height, width
        place += 2 + length
    raise ValueError("a JPEG without a frame")


def _filmed(file: GltfFile, accessors: Accessors, skeleton: Skeleton, axes: Array) -> Clip:
    """The pose in which the person was filmed, one frame."""
    animation = next(one for one in file.parts["animations"] if one.name == FILMED_CLIP_NAME)
    rotations = np.tile(rotation.IDENTITY_QUATERNION, (len(skeleton.names), 1)).astype(np.float64)
    turned = np.zeros(len(rotations), np.bool_)
    root = skeleton.heads[0].astype(np.float64)
    joint_of = {node: joint for joint, node in enumerate(file.parts["skins"][0]["joints"])}
    for channel in animation.channels:
        joint = joint_of.get(channel.target.node)
        if joint is None or channel.target.path not in ("rotation", "translation"):
            continue
        first = accessors.numbers(_sampler(animation, channel).output)[0]
        if channel.target.path == "rotation":
            rotations[joint], turned[joint] = rotation.normalize(first.reshape(4)), True
        elif joint == 0:
            root = _near(first.reshape(1, 3))[0].astype(np.float64)
    above = rotation.from_matrix(axes_above(skeleton, axes))
    own = rotation.chain(above, rotations, rotation.inverse(rotation.from_matrix(axes)))
    own = np.where(turned[:, None], own, rotation.IDENTITY_QUATERNION)
    return Clip(FILMED_CLIP_NAME, 30.0, own[None].astype(np.float32), root[None].astype(np.float32))


def _sampler(animation: Part, channel: Part) -> Any:
    return animation.samplers[channel.sampler]


def _near(places: NDArray[np.floating]) -> NDArray[np.float32]:
    """Places (N, 3) of a person. Raises ValueError where they are none."""
    if places.ndim != 2 or places.shape[1] != 3 or np.abs(places).max() > MAX_BODY_DISTANCE_METRES:
        raise ValueError("it is no person")
    return np.asarray(places, np.float32)
