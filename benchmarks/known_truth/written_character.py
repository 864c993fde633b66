"""A character's GLB read back by other means than it was written by, posed and drawn.

trimesh reads the surface, the picture on it and the tree of joints, and poses that. It leaves out the skin, which is
read by the letter of the specification (Khronos, glTF 2.0, 3.6 and 3.7.3). OpenCV draws the outline.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import trimesh
from numpy.typing import NDArray

from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinned_mesh import SkinnedMesh

COMPONENT_TYPES: dict[int, Any] = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}
COMPONENT_COUNTS = {"VEC3": 3, "VEC4": 4, "MAT4": 16}
OUTLINE_SUPERSAMPLING = 8
"""How many times larger an outline is drawn."""
FRACTION_BITS = 4
"""Bits of OpenCV's fractions of a pixel."""
FILL_OVERHANG_PIXELS = 0.5 / OUTLINE_SUPERSAMPLING
"""Pixels by which OpenCV fills a triangle too wide: every pixel that an edge passes."""


@dataclass(frozen=True)
class Written:
    """What a GLB holds.

    pictured : (V, 3) the vertices as its clip `pictured` has them.
    unbound : by how much the joints at rest times the inverse bind matrices differ from the identity, at most.
    unweighted : weights from one, at most.
    """

    mesh: SkinnedMesh
    pictured: NDArray[np.float64]
    unbound: float
    unweighted: float


def read_written(path: Path) -> Written:
    """Read a character."""
    scene: Any = trimesh.load_scene(path, process=False)
    (surface,) = scene.geometry.values()
    file = _Glb(path)
    skin = file.json["skins"][0]
    names = [file.json["nodes"][node]["name"] for node in skin["joints"]]
    attributes = file.json["meshes"][0]["primitives"][0]["attributes"]
    bones, weights = file.array(attributes["JOINTS_0"]), file.array(attributes["WEIGHTS_0"])
    inverse_bind = file.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    rest = _joints(scene, names)
    _pose(scene, file, "pictured")
    moved = np.einsum("vk,vkij->vij", weights, (_joints(scene, names) @ inverse_bind)[bones])
    above = [scene.graph.transforms.parents[name] for name in names]
    parents = np.array([names.index(name) if name in names else -1 for name in above], np.int32)
    mesh = SkinnedMesh(
        Skeleton(tuple(names), parents, rest[:, :3, 3].astype(np.float32)),
        surface.vertices.astype(np.float32),
        surface.faces.astype(np.int32),
        (surface.visual.uv * [1, -1] + [0, 1]).astype(np.float32),  # trimesh counts from below
        bones.astype(np.uint8),
        weights.astype(np.float32),
        np.asarray(surface.visual.material.baseColorTexture.convert("RGB")),
    )
    return Written(
        mesh,
        np.einsum("vij,vj->vi", moved[:, :3, :3], surface.vertices) + moved[:, :3, 3],
        float(np.abs(rest @ inverse_bind - np.eye(4)).max()),
        float(np.abs(weights.sum(1) - 1).max()),
    )


def outline(points: NDArray[np.floating], triangles: NDArray[np.integer], size: tuple[int, int]) -> NDArray[np.bool_]:
    """(height, width) where triangles between points (V, 2 or 3), pixels, cover at least half of a pixel."""
    canvas = np.zeros((size[0] * OUTLINE_SUPERSAMPLING, size[1] * OUTLINE_SUPERSAMPLING), np.uint8)
    at = ((points[:, :2] + 0.5) * OUTLINE_SUPERSAMPLING - 0.5) * 2**FRACTION_BITS
    for triangle in at.round().astype(np.int32)[triangles]:
        cv2.fillConvexPoly(canvas, triangle, 255, shift=FRACTION_BITS)
    return np.asarray(
        cv2.resize(canvas, size[::-1], interpolation=cv2.INTER_AREA) >= 255 * (0.5 + FILL_OVERHANG_PIXELS)
    )


class _Glb:
    """The JSON of a GLB, and its accessors as arrays."""

    def __init__(self, path: Path):
        data = path.read_bytes()
        end = 20 + int.from_bytes(data[12:16], "little")
        self.json: dict[str, Any] = json.loads(data[20:end])
        self._binary = data[end + 8 :]

    def array(self, index: int) -> NDArray[Any]:
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind, width = COMPONENT_TYPES[accessor["componentType"]], COMPONENT_COUNTS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        found: NDArray[Any] = np.frombuffer(self._binary, kind, accessor["count"] * width, start).reshape(-1, width)
        return found / np.iinfo(kind).max if accessor.get("normalized") else found


def _joints(scene: trimesh.Scene, names: list[str]) -> NDArray[np.float64]:
    return np.stack([scene.graph.get(name)[0] for name in names])


def _pose(scene: trimesh.Scene, file: _Glb, clip: str) -> None:
    """Give each joint what the first frame of a clip says of it."""
    (animation,) = (one for one in file.json["animations"] if one["name"] == clip)
    for channel in animation["channels"]:
        name = file.json["nodes"][channel["target"]["node"]]["name"]
        parent = scene.graph.transforms.parents[name]
        own = scene.graph.get(name, parent)[0].copy()
        first = file.array(animation["samplers"][channel["sampler"]]["output"])[0]
        if channel["target"]["path"] == "translation":
            own[:3, 3] = first
        else:
            own[:3, :3] = trimesh.transformations.quaternion_matrix(first[[3, 0, 1, 2]])[:3, :3]
        scene.graph.update(name, parent, matrix=own)
