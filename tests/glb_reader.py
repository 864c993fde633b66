"""Reads a GLB back by the letter of the specification, sharing nothing with what wrote it; and Khronos' validator."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from missing import missing
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

ROOT = Path(__file__).parents[1]
TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
RESTING = {"translation": (0, 0, 0), "rotation": (0, 0, 0, 1)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def validate(path: Path) -> dict[str, Any]:
    """The issues that Khronos' validator finds. Skips where it is not installed, fails where it must be."""
    if shutil.which("node") is None or not (ROOT / "web/node_modules/gltf-validator").exists():
        message = "gltf-validator is not installed (make setup installs it)"
        missing(message)
    script = Path(__file__).with_name("validate_glb.mjs")
    run = subprocess.run(["node", script, path], capture_output=True, check=True, text=True, timeout=60)
    return json.loads(run.stdout)["issues"]


class Glb:
    """A GLB file: `json`, and its accessors as arrays."""

    def __init__(self, path: Path):
        data = path.read_bytes()
        assert data[:4] == b"glTF" and int.from_bytes(data[8:12], "little") == len(data)
        length = int.from_bytes(data[12:16], "little")
        self.json = json.loads(data[20 : 20 + length])
        self.binary = data[20 + length + 8 :]
        self.nodes = self.json["nodes"]
        self.names = [node["name"] for node in self.nodes]

    def view(self, index: int) -> bytes:
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.binary[start : start + view["byteLength"]]

    def array(self, index: int) -> NDArray:
        accessor = self.json["accessors"][index]
        kind, width = TYPES[accessor["componentType"]], WIDTHS[accessor["type"]]
        if "bufferView" in accessor:
            found = np.frombuffer(
                self.view(accessor["bufferView"]), kind, accessor["count"] * width, accessor.get("byteOffset", 0)
            ).reshape(accessor["count"], width)
        else:
            found = np.zeros((accessor["count"], width), kind)
        if "sparse" in accessor:
            sparse, found = accessor["sparse"], found.copy()
            indices, values = sparse["indices"], sparse["values"]
            rows = np.frombuffer(self.view(indices["bufferView"]), TYPES[indices["componentType"]], sparse["count"])
            new = np.frombuffer(self.view(values["bufferView"]), kind, sparse["count"] * width)
            found[rows] = new.reshape(-1, width)
        if accessor.get("normalized"):
            found = found / np.iinfo(kind).max
        if width == 16:
            found = found.reshape(-1, 4, 4).transpose(0, 2, 1)
        return found

    def attribute(self, name: str, mesh: int = 0) -> NDArray:
        return self.array(self.json["meshes"][mesh]["primitives"][0]["attributes"][name])

    def triangles(self, mesh: int = 0) -> NDArray:
        return self.array(self.json["meshes"][mesh]["primitives"][0]["indices"]).reshape(-1, 3)

    def animation(self, name: str) -> dict[str, Any]:
        return next(each for each in self.json["animations"] if each["name"] == name)

    def posed(self, animation: str, second: float) -> NDArray[np.float64]:
        """(V, 3) the mesh at a moment of an animation that is one of its keys, or between keys by nlerp."""
        own = {
            node: tuple(np.array(each.get(part, still), float) for part, still in RESTING.items())
            for node, each in enumerate(self.nodes)
        }
        moving = self.animation(animation)
        for channel in moving["channels"]:
            sampler = moving["samplers"][channel["sampler"]]
            times, values = self.array(sampler["input"])[:, 0], self.array(sampler["output"])
            value = np.array([np.interp(second, times, column) for column in values.T])
            node, (place, turn) = channel["target"]["node"], own[channel["target"]["node"]]
            own[node] = (value, turn) if channel["target"]["path"] == "translation" else (place, value)
        world: dict[int, NDArray] = {}

        def visit(node: int, above: NDArray) -> None:
            matrix = np.eye(4)
            matrix[:3, :3], matrix[:3, 3] = Rotation.from_quat(own[node][1]).as_matrix(), own[node][0]
            world[node] = above @ matrix
            for child in self.nodes[node].get("children", []):
                visit(child, world[node])

        for node in self.json["scenes"][0]["nodes"]:
            visit(node, np.eye(4))
        skin = self.json["skins"][0]
        joints = np.stack([world[node] for node in skin["joints"]]) @ self.array(skin["inverseBindMatrices"])
        rest = np.concatenate([self.attribute("POSITION"), np.ones((len(self.attribute("POSITION")), 1))], 1)
        blend = np.einsum("vk,vkij->vij", self.attribute("WEIGHTS_0"), joints[self.attribute("JOINTS_0")])
        return np.einsum("vij,vj->vi", blend, rest)[:, :3]
