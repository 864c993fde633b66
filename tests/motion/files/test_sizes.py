"""Motion files that are made to cost: whatever is long, deep or told many times is refused, or read in time that grows
with it and no faster."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from engine.errors import InputError
from engine.motion.files.bvh import read_bvh
from engine.motion.files.gltf_file import MAX_CHANNELS, MAX_NODES, GltfFile
from engine.motion.files.gltf_motion import read_gltf_motion
from engine.motion.files.source_motion import MAX_JOINT_DEPTH, MAX_JOINTS
from engine.motion.retargeting.joint_map import map_joints

DEADLINE_SECONDS = 60
"""Seconds: what these files took before, by far, and no machine takes for what is linear."""


def glb(document: dict[str, Any], data: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(data))
    return head + struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data


def moving(nodes: list[dict[str, Any]], joints: list[int], **more: Any) -> bytes:
    """A file of these nodes, of which the first is turned by ten keys."""
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 1000}],
        "bufferViews": [{"buffer": 0, "byteLength": 1000}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 10, "type": "SCALAR"},
            {"bufferView": 0, "componentType": 5126, "count": 10, "type": "VEC4"},
            {"bufferView": 0, "componentType": 5126, "count": 10, "type": "MAT4"},
        ],
        "nodes": nodes,
        "skins": [{"joints": joints}],
        "animations": [
            {
                "samplers": [{"input": 0, "output": 1}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
            }
        ],
    }
    return glb(document | more, struct.pack("<250f", *(0.1 * i for i in range(250))))


def chain(count: int) -> list[dict[str, Any]]:
    return [{"children": [k + 1]} for k in range(count - 1)] + [{}]


def star(count: int) -> list[dict[str, Any]]:
    return [{"children": list(range(1, count))}, *({} for _ in range(count - 1))]


def comb(count: int) -> list[dict[str, Any]]:
    """A chain of which every joint has a tooth."""
    half = count // 2
    return [{"children": [k + 1, half + k] if k + 1 < half else [half + k]} for k in range(half)] + [{}] * half


@pytest.mark.parametrize("shape", [chain, star, comb])
@pytest.mark.parametrize("count", [MAX_NODES, 100_000])
def test_a_skeleton_of_any_shape_beyond_measure_is_refused_soon(
    shape: Callable[[int], list[dict[str, Any]]], count: int
) -> None:
    data = moving(shape(count), [0])
    begin = time.monotonic()
    with pytest.raises(InputError) as error:
        read_gltf_motion(data)
    assert error.value.code == "motion_too_large"
    assert time.monotonic() - begin < DEADLINE_SECONDS


@pytest.mark.parametrize("shape", [chain, star, comb])
def test_the_largest_skeleton_that_is_read_is_read_soon(shape: Callable[[int], list[dict[str, Any]]]) -> None:
    """And whoever looks among its joints for a person's finds none as soon."""
    begin = time.monotonic()
    motion = read_gltf_motion(moving(shape(MAX_JOINTS), [0]))
    assert len(motion.names) == MAX_JOINTS
    with pytest.raises(InputError, match="motion_not_humanoid"):
        map_joints(motion)
    assert time.monotonic() - begin < DEADLINE_SECONDS


def test_a_joint_in_many_skins_is_bound_once() -> None:
    joints = list(range(10))
    skins = [{"joints": joints, "inverseBindMatrices": 2}] * 6000
    begin = time.monotonic()
    motion = read_gltf_motion(moving(chain(10), joints, skins=skins))
    assert len(motion.names) == 10
    with pytest.raises(InputError, match="motion_too_large"):
        read_gltf_motion(moving(chain(10), joints, skins=skins * 2))
    assert time.monotonic() - begin < DEADLINE_SECONDS


def test_a_view_is_no_copy_of_its_buffer() -> None:
    """Exporters lay all keys of all joints in one view, and hostile files tens of thousands of accessors in 64 MB."""
    file = GltfFile(moving(chain(2), [0], bufferViews=[{"buffer": 0, "byteOffset": 100, "byteLength": 800}]))
    views = [np.frombuffer(file.view(0)[0], np.uint8) for _ in range(2)]
    assert len(views[0]) == 800 and np.shares_memory(*views)


def test_animations_and_channels_without_end_are_refused() -> None:
    channel = {"sampler": 0, "target": {"node": 0, "path": "rotation"}}
    samplers = [{"input": 0, "output": 1}]
    many = [{"samplers": samplers, "channels": [channel] * (MAX_CHANNELS + 1)}]
    for animations in (many, [{"samplers": samplers, "channels": [channel]}] * 5000):
        with pytest.raises(InputError, match="motion_too_large"):
            read_gltf_motion(moving(chain(10), [0], animations=animations))


def test_json_that_is_nested_deeply_or_counts_beyond_numbers_is_refused() -> None:
    for extras in (b"[" * 100_000 + b"]" * 100_000, b"9" * 100_000):
        with pytest.raises(InputError, match="motion_unreadable"):
            read_gltf_motion(b'{"asset": {"version": "2.0"}, "extras": ' + extras + b"}")


def bvh(joints: int, nested: bool, frames: int = 2) -> bytes:
    line = "JOINT j\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    inner = line * joints + "}\n" * joints if nested else (line + "}\n") * joints
    head = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    numbers = (" ".join(["1"] * 3 * (joints + 1)) + "\n") * frames
    return (head + inner + f"}}\nMOTION\nFrames: {frames}\nFrame Time: 0.04\n" + numbers).encode()


@pytest.mark.parametrize("nested", [True, False])
def test_bvh_of_the_most_joints_is_read_soon_and_of_more_refused(nested: bool) -> None:
    most = MAX_JOINT_DEPTH - 2 if nested else MAX_JOINTS - 1
    begin = time.monotonic()
    assert len(read_bvh(bvh(most, nested)).names) == most + 1
    for count in (most + 5, 20_000):
        with pytest.raises(InputError, match="motion_too_large"):
            read_bvh(bvh(count, nested, 0))
    assert np.isfinite(read_bvh(bvh(3, nested, 3)).rotations).all()
    assert time.monotonic() - begin < DEADLINE_SECONDS
