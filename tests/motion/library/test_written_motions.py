"""What we write we read: our own characters' clips come back the same, however the same numbers lie in the file."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from template_character import template_character

from engine.export.gltf.glb import CharacterModel, write_glb
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion.library import built_in

Document = dict[str, Any]
CLIPS = ("walk", "wave", "jump")


def packed(document: Document, data: bytes) -> bytes:
    document["buffers"][0]["byteLength"] = len(data)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def turns(document: Document) -> list[Document]:
    """The samplers that turn joints."""
    return [
        animation["samplers"][channel["sampler"]]
        for animation in document["animations"]
        for channel in animation["channels"]
        if channel["target"]["path"] == "rotation"
    ]


def lies_at(document: Document, accessor: Document) -> int:
    view = document["bufferViews"][accessor["bufferView"]]
    return int(view.get("byteOffset", 0) + accessor.get("byteOffset", 0))


def add_view(document: Document, data: bytes, raw: bytes, **more: int) -> tuple[int, bytes]:
    data += bytes(-len(data) % 4)
    document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(raw)} | more)
    return len(document["bufferViews"]) - 1, data + raw


def as_it_is(document: Document, data: bytes) -> bytes:
    return packed(document, data)


def in_itself(document: Document, data: bytes) -> bytes:
    document["buffers"][0] |= {"uri": "data:;base64," + base64.b64encode(data).decode(), "byteLength": len(data)}
    return json.dumps(document).encode()


def sparse(document: Document, data: bytes) -> bytes:
    """Every second turn lies elsewhere, and zeros in its place."""
    changed = bytearray(data)
    for number in {sampler["output"] for sampler in turns(document)}:
        accessor = document["accessors"][number]
        kept = list(range(0, accessor["count"], 2))
        row = {5126: 16, 5122: 8}[accessor["componentType"]]
        begin = lies_at(document, accessor)
        values = b"".join(data[begin + row * k : begin + row * (k + 1)] for k in kept)
        for k in kept:
            changed[begin + row * k : begin + row * (k + 1)] = bytes(row)
        indices, whole = add_view(document, bytes(changed), struct.pack(f"<{len(kept)}H", *kept))
        view, whole = add_view(document, whole, values)
        changed = bytearray(whole)
        accessor["sparse"] = {
            "count": len(kept),
            "indices": {"bufferView": indices, "componentType": 5123},
            "values": {"bufferView": view},
        }
    return packed(document, bytes(changed))


def strided(document: Document, data: bytes) -> bytes:
    """Turns with something else between them."""
    for number in {sampler["output"] for sampler in turns(document)}:
        accessor = document["accessors"][number]
        row = {5126: 16, 5122: 8}[accessor["componentType"]]
        begin = lies_at(document, accessor)
        rows = [data[begin + row * k : begin + row * (k + 1)] + b"\x7f" * 12 for k in range(accessor["count"])]
        accessor["bufferView"], data = add_view(document, data, b"".join(rows), byteStride=row + 12)
        accessor.pop("byteOffset", None)
    return packed(document, data)


def other_names(document: Document, data: bytes) -> bytes:
    for node in document["nodes"]:
        node["name"] = f"hero_{node['name']}_jnt"
    return packed(document, data)


VARIANTS = [as_it_is, in_itself, sparse, strided, other_names]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, dict[str, Clip]]:
    mesh = template_character(texture_size=16)
    clips = {name: built_in(name, mesh.skeleton) for name in CLIPS}
    path: Path = tmp_path_factory.mktemp("written") / "character.glb"
    write_glb(path, CharacterModel(mesh, list(clips.values())))
    return path.read_bytes(), clips


@pytest.mark.parametrize("variant", VARIANTS)
def test_our_own_clips_come_back(
    written: tuple[bytes, dict[str, Clip]], variant: Callable[[Document, bytes], bytes]
) -> None:
    content, clips = written
    size = struct.unpack_from("<I", content, 12)[0]
    file = variant(json.loads(content[20 : 20 + size]), content[28 + size :])
    for name, clip in clips.items():
        motion = read_gltf_motion(file, name)
        plain = [one.removeprefix("hero_").removesuffix("_jnt") for one in motion.names]
        order = [plain.index(joint) for joint in template_character(texture_size=16).skeleton.names]
        frames = len(clip.rotations)
        assert motion.fps == clip.fps and len(motion.rotations) == frames + clip.loops
        apart = rotation.multiply(rotation.inverse(motion.rotations[:frames, order]), clip.rotations.astype(np.float64))
        assert rotation.angle(apart).max() < 2e-4, "radians"
        np.testing.assert_allclose(motion.world()[1][:frames, order[0]], clip.root, atol=1e-4)


def test_they_come_back_from_joints_with_axes_of_their_own(tmp_path: Path) -> None:
    mesh = template_character(texture_size=16)
    clip = built_in("dance", mesh.skeleton)
    places = []
    for mixamo in (False, True):
        write_glb(tmp_path / "avatar.glb", CharacterModel(mesh, [clip], mixamo=mixamo))
        motion = read_gltf_motion((tmp_path / "avatar.glb").read_bytes(), "dance")
        places.append(motion.world()[1][:, [motion.names.index(joint) for joint in mesh.skeleton.names]])
    np.testing.assert_allclose(places[1], places[0], atol=1e-4)
