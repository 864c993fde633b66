"""The optional parts of glTF's core, and files that lie about their sizes: numbers known beforehand come back, or an error
with a code."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.errors import InputError
from engine.motion import rotation
from engine.motion.files.bvh import read_bvh
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion.files.source_motion import SourceMotion

FRAMES, JOINTS = 7, 12
CODES = {1: 5120, 2: 5122}


class File:
    """A chain of joints that turn: a file in the making, whose JSON and bytes a test may change."""

    def __init__(self) -> None:
        self.data = bytearray()
        chain = [{"name": f"joint {k}", "translation": [0, 1, 0], "children": [k + 1]} for k in range(JOINTS - 1)]
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "buffers": [{}],
            "bufferViews": [],
            "accessors": [],
            "nodes": [*chain, {"name": "tip", "translation": [0, 1, 0]}],
            "skins": [{"joints": list(range(JOINTS))}],
        }
        angles = 0.4 * np.sin(np.arange(FRAMES)[:, None] + np.arange(JOINTS))
        self.turns = rotation.about("x", angles).astype(np.float32)
        self.times = (np.arange(FRAMES) / 30).astype(np.float32)
        keys = self.accessor(self.times.tobytes(), "SCALAR")
        outputs = [self.accessor(self.turns[:, k].tobytes(), "VEC4") for k in range(JOINTS)]
        self.json["animations"] = [
            {
                "name": "nod",
                "samplers": [{"input": keys, "output": output} for output in outputs],
                "channels": [{"sampler": k, "target": {"node": k, "path": "rotation"}} for k in range(JOINTS)],
            }
        ]

    def view(self, raw: bytes, **more: int) -> int:
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw)} | more)
        self.data += raw
        return len(self.json["bufferViews"]) - 1

    def accessor(self, raw: bytes | None, kind: str, count: int = FRAMES, component: int = 5126, **more: Any) -> int:
        said = {"componentType": component, "count": count, "type": kind} | more
        self.json["accessors"].append(said if raw is None else said | {"bufferView": self.view(raw)})
        return len(self.json["accessors"]) - 1

    def turned_by(self, accessor: int, joint: int = 3) -> None:
        self.json["animations"][0]["samplers"][joint]["output"] = accessor

    def bytes(self) -> bytes:
        data = bytes(self.data) + bytes(-len(self.data) % 4)
        self.json["buffers"][0].setdefault("byteLength", len(self.data))
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def read(file: File) -> SourceMotion:
    return read_gltf_motion(file.bytes())


def same(file: File, atol: float = 1e-6) -> bool:
    return bool(np.allclose(read(file).rotations, file.turns, atol=atol))


def test_sparse_accessors_change_what_lies_beneath_them() -> None:
    for base, component in ((True, 5121), (True, 5123), (False, 5125)):
        file = File()
        wrong = file.turns[:, 3].copy()
        wrong[[1, 4]] = (0, 1, 0, 0)
        places = [1, 4] if base else list(range(FRAMES))
        size = {5121: "B", 5123: "H", 5125: "I"}[component]
        sparse = {
            "count": len(places),
            "indices": {
                "bufferView": file.view(struct.pack(f"<{len(places)}{size}", *places)),
                "componentType": component,
            },
            "values": {"bufferView": file.view(file.turns[places, 3].tobytes())},
        }
        file.turned_by(file.accessor(wrong.tobytes() if base else None, "VEC4", sparse=sparse))
        assert same(file)


def test_an_accessor_without_a_view_is_zeros() -> None:
    file = File()
    file.json["animations"][0]["samplers"].append({"input": 0, "output": file.accessor(None, "VEC3")})
    file.json["animations"][0]["channels"].append({"sampler": JOINTS, "target": {"node": 2, "path": "translation"}})
    assert same(file) and (read(file).translations[:, 2] == 0).all() and (read(file).translations[:, 3, 1] == 1).all()


@pytest.mark.parametrize(("kind", "component"), [("i1", 5120), ("u1", 5121), ("i2", 5122), ("u2", 5123)])
def test_whole_numbers_are_fractions_of_their_type(kind: str, component: int) -> None:
    file = File()
    most = np.iinfo(kind).max
    turns = np.abs(file.turns[:, 3]) if kind[0] == "u" else file.turns[:, 3]
    raw = np.round(turns * most).astype(kind)
    file.turned_by(file.accessor(raw.tobytes(), "VEC4", component=component, normalized=True))
    expected = rotation.normalize(raw.astype(float) / most)
    np.testing.assert_allclose(read(file).rotations[:, 3], expected, atol=1e-6)


def test_interleaved_keys_are_read_by_their_stride() -> None:
    file = File()
    rows = np.concatenate([file.turns[:, 3], file.turns[:, 4], file.times[:, None]], 1)
    view = file.view(rows.tobytes(), byteStride=36)
    for joint, start in ((3, 0), (4, 16)):
        file.turned_by(file.accessor(None, "VEC4", bufferView=view, byteOffset=start), joint)
    file.json["animations"][0]["samplers"][4]["input"] = file.accessor(None, "SCALAR", bufferView=view, byteOffset=32)
    assert same(file)


def test_a_node_may_have_a_matrix() -> None:
    file = File()
    turned = rotation.to_matrix(rotation.about("z", 0.5))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = 2 * turned, (1, 2, 3)
    file.json["nodes"].append({"name": "above", "matrix": matrix.T.ravel().tolist(), "children": [0]})
    motion = read(file)
    above, below = motion.names.index("above"), motion.names.index("joint 0")
    np.testing.assert_allclose(motion.rotations[0, above], rotation.about("z", 0.5), atol=1e-6)
    np.testing.assert_allclose(motion.translations[0, [above, below]], [(1, 2, 3), (0, 2, 0)], atol=1e-6)


def test_two_views_of_the_same_bytes_are_allowed() -> None:
    file = File()
    file.json["accessors"][4]["bufferView"] = file.json["accessors"][3]["bufferView"]
    file.turns[:, 3] = file.turns[:, 2]
    assert same(file)


def test_only_extensions_of_what_is_read_matter() -> None:
    file = File()
    name = "EXT_meshopt_compression"
    file.json["extensionsRequired"] = [
        "KHR_draco_mesh_compression",
        "KHR_mesh_quantization",
        "KHR_texture_basisu",
        name,
    ]
    file.json["meshes"] = [{"primitives": [{"extensions": {"KHR_draco_mesh_compression": {}}}]}]
    file.json["accessors"].append({"bufferView": len(file.json["bufferViews"])})
    file.json["bufferViews"].append({"buffer": 1, "byteLength": 1 << 40, "extensions": {name: {}}})
    assert same(file), "a mesh is packed, and no key"
    name = "KHR_meshopt_compression"
    for kind in ("buffers", "bufferViews", "accessors"):
        packed = File()
        packed.json["extensionsRequired"] = [name]
        packed.json[kind][0]["extensions"] = {name: {}}
        with pytest.raises(InputError, match=f"{name}.*export it without") as error:
            read(packed)
        assert error.value.code == "motion_extension"


def test_an_extension_that_need_not_be_known_is_passed_over_where_its_numbers_are_there() -> None:
    file = File()
    file.json["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": {}}
    assert same(file)
    file.json["buffers"].append({"byteLength": 400, "extensions": {"EXT_meshopt_compression": {"fallback": True}}})
    file.json["bufferViews"][0]["buffer"] = 1
    with pytest.raises(InputError, match="EXT_meshopt_compression"):
        read(file)


def lying(how: str) -> bytes:
    file = File()
    accessor, view, buffer = file.json["accessors"][4], file.json["bufferViews"][4], file.json["buffers"][0]
    match how:
        case "a view beyond its buffer":
            view["byteLength"] = 1 << 40
        case "a view before its buffer":
            view["byteOffset"] = -16
        case "an accessor beyond its view":
            accessor["byteOffset"] = 4
        case "an accessor before its view":
            accessor["byteOffset"] = -4
        case "a buffer longer than its bytes":
            buffer["byteLength"] = 1 << 40
        case "a view beyond what its buffer says":
            buffer["byteLength"] = 64
        case "a negative count":
            accessor["count"] = -7
        case "a count that is no whole number":
            accessor["count"] = 7.5
        case "a count beyond floats":
            accessor["count"] = 10**400
        case "a stride that is too small":
            view["byteStride"] = 4
        case "a negative stride":
            view["byteStride"] = -16
        case "a truth for a number":
            accessor["bufferView"] = True
        case "zeros beyond measure":
            del accessor["bufferView"]
            accessor["count"] = 1 << 31
        case "a sparse place beyond the accessor":
            sparse = {"count": 1, "indices": {"bufferView": file.view(b"\x63\0"), "componentType": 5123}}
            accessor["sparse"] = sparse | {"values": {"bufferView": file.view(bytes(16))}}
        case "sparse places that are not in order":
            sparse = {"count": 2, "indices": {"bufferView": file.view(b"\2\1"), "componentType": 5121}}
            accessor["sparse"] = sparse | {"values": {"bufferView": file.view(bytes(32))}}
        case "a sparse place twice":
            sparse = {"count": 2, "indices": {"bufferView": file.view(b"\1\1"), "componentType": 5121}}
            accessor["sparse"] = sparse | {"values": {"bufferView": file.view(bytes(32))}}
        case "more sparse places than there are":
            accessor["sparse"] = {"count": 1 << 40, "indices": {"bufferView": 0}, "values": {"bufferView": 0}}
        case "a rotation of three numbers":
            file.json["nodes"][2]["rotation"] = [0, 0, 1]
        case "a place beyond floats":
            file.json["nodes"][2]["translation"] = [10**400, 0, 0]
        case "a scale that is a list":
            file.json["nodes"][2]["scale"] = [[1], 1, 1]
        case "not JSON's numbers":
            file.json["nodes"][2]["scale"] = [float("nan"), 1, 1]
    data = file.bytes()
    match how:
        case "a file shorter than it says":
            return data[:-8]
        case "a chunk longer than its file":
            return data[:12] + struct.pack("<I", 1 << 31) + data[16:]
        case "numbers longer than their file":
            size = struct.unpack_from("<I", data, 12)[0]
            return data[: 20 + size] + struct.pack("<I", 0xFFFFFFFF) + data[24 + size :]
        case "a file that says it ends in its JSON":
            return data[:8] + struct.pack("<I", 100) + data[12:]
        case "another chunk first":
            return data[:16] + b"BIN\0" + data[20:]
    return data


LYING = [
    "a view beyond its buffer", "a view before its buffer", "an accessor beyond its view", "an accessor before its view",
    "a buffer longer than its bytes", "a view beyond what its buffer says", "a negative count",
    "a count that is no whole number", "a count beyond floats", "a stride that is too small", "a negative stride",
    "a truth for a number", "zeros beyond measure", "a sparse place beyond the accessor",
    "sparse places that are not in order", "a sparse place twice", "more sparse places than there are",
    "a rotation of three numbers",
    "a place beyond floats", "a scale that is a list", "not JSON's numbers", "a file shorter than it says",
    "a chunk longer than its file", "numbers longer than their file", "a file that says it ends in its JSON",
    "another chunk first",
]  # fmt: skip


@pytest.mark.parametrize("how", LYING)
def test_files_that_lie_are_refused(how: str) -> None:
    with pytest.raises(InputError) as error:
        read_gltf_motion(lying(how))
    assert error.value.code == ("motion_too_large" if how == "zeros beyond measure" else "motion_unreadable")


@pytest.mark.parametrize("scales", [(1, 1), (1e200, 1e200)], ids=["said so", "by its parents' scales"])
def test_a_place_that_is_not_finite_is_refused(scales: tuple[float, float]) -> None:
    file = File()
    for node, scale in zip(file.json["nodes"], scales, strict=False):
        node["scale"] = [scale] * 3
    if scales == (1, 1):
        file.json["nodes"][2]["translation"] = [12345, 0, 0]
    with pytest.raises(InputError) as error:
        read_gltf_motion(file.bytes().replace(b"12345", b"1e999"))
    assert error.value.code == "motion_not_finite"


def two(still_first: bool, under_one_root: bool, skinned: bool) -> File:
    """Somebody who nods, and somebody of the same kind who does not."""
    file = File()
    nodes = file.json["nodes"]
    file.json["nodes"] += [
        node | ({"children": [child + JOINTS for child in node["children"]]} if "children" in node else {})
        for node in nodes
    ]
    file.json["skins"].append({"joints": list(range(JOINTS, 2 * JOINTS))})
    if still_first:
        for channel in file.json["animations"][0]["channels"]:
            channel["target"]["node"] += JOINTS
    if under_one_root:
        file.json["nodes"].append({"name": "scene", "children": [0, JOINTS]})
    if not skinned:
        del file.json["skins"]
    return file


@pytest.mark.parametrize("still_first", [True, False])
@pytest.mark.parametrize("under_one_root", [True, False])
@pytest.mark.parametrize("skinned", [True, False])
def test_of_two_skeletons_the_one_that_moves_is_taken(still_first: bool, under_one_root: bool, skinned: bool) -> None:
    file = two(still_first, under_one_root, skinned)
    motion = read(file)
    own = [name for name in motion.names if name != "scene"]
    assert own == [f"joint {k}" for k in range(JOINTS - 1)] + ["tip"]
    moved = motion.rotations[:, [motion.names.index(name) for name in own]]
    np.testing.assert_allclose(moved, file.turns, atol=1e-6)
    assert motion.skeletons == ("joint 0",) * (2 if skinned else 1)


def test_what_two_skeletons_hang_on_may_turn_and_joins_them_not() -> None:
    file = two(still_first=False, under_one_root=True, skinned=True)
    file.json["animations"][0]["channels"].append({"sampler": 0, "target": {"node": 2 * JOINTS, "path": "rotation"}})
    assert read(file).skeletons == ("joint 0", "joint 0")


def test_the_clip_that_is_asked_for_says_whose_skeleton() -> None:
    file = two(still_first=False, under_one_root=True, skinned=True)
    nod = file.json["animations"][0]
    other = [
        {"sampler": c["sampler"], "target": {"node": c["target"]["node"] + JOINTS, "path": "rotation"}}
        for c in nod["channels"]
    ]
    file.json["animations"].append(nod | {"name": "other", "channels": other})
    file.json["nodes"][JOINTS]["name"] = "somebody else"
    for clip, first in ((None, "joint 0"), ("nod", "joint 0"), ("other", "somebody else")):
        motion = read_gltf_motion(file.bytes(), clip)
        assert motion.skeletons[0] == first and first in motion.names


def test_a_prop_that_moves_first_is_no_skeleton() -> None:
    file = File()
    file.json["nodes"].append({"name": "door"})
    door = {"sampler": 1, "target": {"node": JOINTS, "path": "rotation"}}
    file.json["animations"].insert(0, file.json["animations"][0] | {"name": "door", "channels": [door]})
    assert read(file).name == "nod" and same(file)


WHOLE = File().bytes()
BVH = (
    b"HIERARCHY\nROOT a\n{\n OFFSET 0 0 0\n CHANNELS 3 Zrotation Xrotation Yrotation\n JOINT b\n {\n  OFFSET 0 1 0\n"
    b"  CHANNELS 1 Xrotation\n  End Site\n  {\n   OFFSET 0 1 0\n  }\n }\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n1 2 3 4\n5 6 7 8\n"
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.sampled_from([WHOLE, BVH]),
    st.lists(
        st.tuples(st.floats(0, 1), st.sampled_from([*b'0193-{}[]:,"e. \n\xff\0nN']) | st.integers(0, 255)), max_size=6
    ),
    st.floats(0, 1),
    st.booleans(),
)
def test_changed_bytes_are_read_or_refused(
    data: bytes, changes: list[tuple[float, int]], cut: float, whole: bool
) -> None:
    spoiled = bytearray(data)
    for where, byte in changes:
        spoiled[int(where * (len(spoiled) - 1))] = byte
    given_bytes = bytes(spoiled if whole else spoiled[: int(cut * len(spoiled))])
    try:
        motion = read_gltf_motion(given_bytes) if data is WHOLE else read_bvh(given_bytes)
    except InputError as error:
        assert error.code.startswith("motion_")
    else:
        assert np.isfinite(motion.rotations).all() and np.isfinite(motion.translations).all()
