"""Rigged characters of GLB files, brought to A-pose or to where a clip begins, by the letter of the specification (Khronos, glTF 2.0, 3.7.3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial.transform import Rotation

from engine.body.rest_pose import shortest_rotation
from engine.motion.files.gltf_accessors import COMPONENT_COUNTS
from engine.motion.files.gltf_file import GltfFile, Part

COMPONENT_TYPES: dict[int, Any] = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
ARM_DEGREES = 50.0
"""Of the arms below the horizontal."""
LEG_DEGREES = 8.0
"""Of the legs from the vertical."""
PLAIN_RGB = (200, 200, 200)
"""Of parts without a texture."""


@dataclass(frozen=True)
class TexturedPart:
    """A piece of a surface with an image of its own."""

    vertices: NDArray[np.float64]
    """(V, 3) in the file's unit."""
    triangles: NDArray[np.int64]
    """(T, 3)."""
    uv: NDArray[np.float64]
    """(V, 2) places on the image, (0, 0) its top left corner; beyond [0, 1] it repeats."""
    image: NDArray[np.uint8]
    """(H, W, 3) sRGB."""
    arms: NDArray[np.float64]
    """(2, V) how far each vertex goes with the left and the right arm."""


def read_in_a_pose(path: Path, facing: float) -> tuple[list[TexturedPart], dict[str, NDArray[np.float64]]]:
    """The parts of a character, and its joints (3,) by their names in Mixamo's rig; `facing`: 1 where it looks along +z, -1
    where along -z."""
    file = GltfFile(path)
    nodes = file.parts.nodes
    skin = file.parts.skins[0]
    names = {joint: str(nodes[joint].name).removeprefix("mixamorig:") for joint in skin.joints}
    towards = np.diag([facing, 1.0, facing])
    worlds = node_worlds(file, lambda node, world: world)
    turns = _a_pose({names[j]: towards @ worlds[j][:3, 3] for j in names})

    def turned(node: int, world: NDArray[np.float64]) -> NDArray[np.float64]:
        if names.get(node) not in turns:
            return world
        turn = np.eye(4)
        turn[:3, :3] = towards @ turns[names[node]] @ towards
        turn[:3, 3] = world[:3, 3] - turn[:3, :3] @ world[:3, 3]
        return np.asarray(turn @ world)

    posed = node_worlds(file, turned)
    below = {side: _below(file, next(j for j in names if names[j] == f"{side}Arm")) for side in ("Left", "Right")}
    parts = [
        part
        for node in nodes
        if node.mesh is not None and node.skin is not None
        for part in _parts(file, node, posed, below, towards)
    ]
    return parts, {names[j]: towards @ posed[j][:3, 3] for j in names}


def read_in_clip(path: Path, clip: str) -> list[TexturedPart]:
    """The parts of a character as they are at the beginning of one of its clips."""
    file = GltfFile(path)
    nodes = [Part(node) for node in file.parts.nodes]
    animation = next(one for one in file.parts.animations if one.name == clip)
    for channel in animation.channels:
        if channel.target.path in ("rotation", "translation"):
            first = accessor_array(file, animation.samplers[channel.sampler].output)[0]
            nodes[channel.target.node][channel.target.path] = first.tolist()
    posed = node_worlds(file, lambda node, world: world, nodes)
    return [part for node in nodes if node.mesh is not None for part in _parts(file, node, posed, {}, np.eye(3))]


def node_worlds(
    file: GltfFile,
    turned: Callable[[int, NDArray[np.float64]], NDArray[np.float64]],
    nodes: Sequence[Any] | None = None,
) -> NDArray[np.float64]:
    """(N, 4, 4) each node to the world; `turned` may turn a node, and with it all below. `nodes` may stand in for the
    file's."""
    nodes = file.parts.nodes if nodes is None else nodes
    worlds = np.tile(np.eye(4), (len(nodes), 1, 1))
    waiting = [(root, np.eye(4)) for root in file.parts.scenes[file.parts.scene or 0].nodes]
    while waiting:
        node, above = waiting.pop()
        worlds[node] = turned(node, above @ _local(nodes[node]))
        waiting += [(child, worlds[node]) for child in nodes[node].children or ()]
    return worlds


def _local(node: Any) -> NDArray[np.float64]:
    if node.matrix:
        return np.array(node.matrix, np.float64).reshape(4, 4).T
    own = np.eye(4)
    own[:3, :3] = Rotation.from_quat(node.rotation or (0, 0, 0, 1)).as_matrix() * np.array(node.scale or (1, 1, 1))
    own[:3, 3] = node.translation or (0, 0, 0)
    return own


def _a_pose(joints: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """The turns (3, 3) in the world of those joints that have to be."""
    turns = {}
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        arm, leg = np.radians(ARM_DEGREES), np.radians(LEG_DEGREES)
        down = np.array([sign * np.cos(arm), -np.sin(arm), 0.02])
        turns[f"{side}Arm"] = shortest_rotation(joints[f"{side}ForeArm"] - joints[f"{side}Arm"], down)
        thigh = joints[f"{side}Leg"] - joints[f"{side}UpLeg"]
        apart = np.array([sign * np.sin(leg), -np.cos(leg), thigh[2] / np.linalg.norm(thigh)])
        turns[f"{side}UpLeg"] = shortest_rotation(thigh, apart)
        turns[f"{side}Foot"] = turns[f"{side}UpLeg"].T
    return turns


def _below(file: GltfFile, node: int) -> set[int]:
    found = {node}
    for child in file.parts.nodes[node].children or ():
        found |= _below(file, child)
    return found


def _parts(
    file: GltfFile,
    node: Any,
    posed: NDArray[np.float64],
    below: Mapping[str, set[int]],
    towards: NDArray[np.float64],
) -> list[TexturedPart]:
    skin = file.parts.skins[node.skin]
    inverse_bind = accessor_array(file, skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
    moves = posed[skin.joints] @ inverse_bind
    carried = np.array([[joint in below.get(side, ()) for joint in skin.joints] for side in ("Left", "Right")], float)
    found = []
    for primitive in file.parts.meshes[node.mesh].primitives:
        at = primitive.attributes
        weights, bones = (
            accessor_array(file, at.WEIGHTS_0).astype(np.float64),
            accessor_array(file, at.JOINTS_0).astype(int),
        )
        weights /= weights.sum(1, keepdims=True)
        blended = np.einsum("vk,vkij->vij", weights, moves[bones])
        points = np.einsum("vij,vj->vi", blended[:, :3, :3], accessor_array(file, at.POSITION)) + blended[:, :3, 3]
        arms = np.einsum("vk,svk->sv", weights, carried[:, bones])
        triangles = accessor_array(file, primitive.indices).reshape(-1, 3).astype(np.int64)
        image = material_image(file, file.parts.materials[primitive.material])
        found.append(
            TexturedPart(points @ towards.T, triangles, accessor_array(file, at.TEXCOORD_0).astype(float), image, arms)
        )
    return found


def accessor_array(file: GltfFile, index: int) -> NDArray[Any]:
    """What an accessor holds, (count,) or (count, width), normalised where it says so."""
    accessor = file.parts.accessors[index]
    data, view = file.view(accessor.bufferView)
    kind, width = np.dtype(COMPONENT_TYPES[accessor.componentType]), COMPONENT_COUNTS[accessor.type]
    step = view.byteStride or kind.itemsize * width
    found = np.ndarray((accessor.count, width), kind, data, accessor.byteOffset or 0, (step, kind.itemsize)).copy()
    return found / np.iinfo(kind).max if accessor.normalized else found


def material_image(file: GltfFile, material: Any) -> NDArray[np.uint8]:
    """A material's colours, (H, W, 3) sRGB; plain ones where it has no texture."""
    colour = material.pbrMetallicRoughness.baseColorTexture
    if not colour:
        return np.full((8, 8, 3), PLAIN_RGB, np.uint8)
    data, _ = file.view(file.parts.images[file.parts.textures[colour.index].source].bufferView)
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"), np.uint8)
