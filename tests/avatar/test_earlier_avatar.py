"""Avatars read back from their files: what was written is what is found, and nothing else is taken for one."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb
from made_motion import bvh
from template_avatar import template_avatar

from engine.avatar.acting import Scene
from engine.avatar.avatar import Avatar
from engine.avatar.earlier_avatar import read_avatar
from engine.avatar.options import AvatarOptions
from engine.avatar.writing import write_avatar
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig
from engine.errors import InputError
from engine.geometry.rigging.half_joints import whole_joints
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.half_turns import with_half_turns
from engine.motion.library import built_in
from engine.run import Run


@pytest.fixture(scope="module")
def avatar() -> Avatar:
    """One that was filmed with its arms lowered, half a step aside."""
    made = template_avatar(64)
    turns, root = made.filmed.rotations.copy(), made.filmed.root.copy()
    for side, name in ((1, "LeftArm"), (-1, "RightArm")):
        turns[0, made.mesh.skeleton.index(name)] = [0, 0, -side * np.sin(0.4), np.cos(0.4)]
    root[0, 0] += 0.25
    return replace(made, filmed=replace(made.filmed, rotations=turns, root=root))


@pytest.fixture(scope="module")
def glb(avatar: Avatar, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("earlier")
    with Run() as run:
        write_avatar(out, avatar, Scene(built_in("wave", avatar.mesh.skeleton)), AvatarOptions(), run)
    return out / "avatar.glb"


@pytest.fixture(scope="module")
def found(glb: Path) -> Avatar:
    return read_avatar(glb)


def test_its_shape_is_the_same(avatar: Avatar, found: Avatar) -> None:
    before, after = avatar.mesh, found.mesh
    assert np.array_equal(after.vertices, before.vertices)
    assert np.array_equal(after.triangles, before.triangles)
    assert np.array_equal(after.uv, before.uv)
    assert after.skeleton.names == before.skeleton.names
    assert np.abs(after.skeleton.heads - before.skeleton.heads).max() < 1e-6
    weights = [np.zeros((len(mesh.vertices), len(mesh.skeleton.names))) for mesh in (before, after)]
    for all_of, mesh in zip(weights, (before, after), strict=True):
        np.add.at(all_of, (np.arange(len(mesh.bones))[:, None], mesh.bones), mesh.weights)
    assert np.abs(weights[0] - weights[1]).max() < 1 / 255


def test_its_expressions_are_the_same(avatar: Avatar, found: Avatar) -> None:
    count = len(avatar.mesh.vertices)
    assert [one.name for one in found.morphs] == [one.name for one in avatar.morphs]
    for before, after in zip(avatar.morphs, found.morphs, strict=True):
        assert np.abs(before.dense(count) - after.dense(count)).max() < 2e-6, before.name


def test_it_stands_as_it_was_filmed(avatar: Avatar, found: Avatar) -> None:
    stood = with_half_turns(avatar.mesh.skeleton, avatar.filmed.rotations)
    between = rotation.multiply(rotation.inverse(stood), found.filmed.rotations)
    assert rotation.angle(between).max() < 1e-3
    assert np.abs(found.filmed.root - avatar.filmed.root).max() < 1e-6


def test_one_without_half_joints_is_read_as_it_is(avatar: Avatar, tmp_path: Path) -> None:
    skeleton = avatar.mesh.skeleton
    count = len(load_rig(HUMAN_RIG).names)
    plain = Skeleton(skeleton.names[:count], skeleton.parents[:count], skeleton.heads[:count])
    mesh = replace(avatar.mesh, skeleton=plain, bones=whole_joints(skeleton)[avatar.mesh.bones])
    filmed = replace(avatar.filmed, rotations=avatar.filmed.rotations[:, :count])
    with Run() as run:
        write_avatar(
            tmp_path, Avatar(mesh, avatar.morphs, filmed), Scene(built_in("wave", plain)), AvatarOptions(), run
        )
    assert read_avatar(tmp_path / "avatar.glb").mesh.skeleton.names == plain.names


def test_its_texture_has_been_through_a_jpeg_and_is_hardly_another(avatar: Avatar, found: Avatar) -> None:
    assert found.mesh.texture.shape == avatar.mesh.texture.shape
    assert np.abs(found.mesh.texture.astype(int) - avatar.mesh.texture).mean() < 1


def refused(path: Path) -> str:
    with pytest.raises(InputError) as error:
        read_avatar(path)
    return error.value.code


def changed(glb: Path, to: Path, document: dict[str, object]) -> Path:
    """The file with other JSON."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = Glb(glb).binary
    chunks = len(text).to_bytes(4, "little") + b"JSON" + text + len(binary).to_bytes(4, "little") + b"BIN\0" + binary
    to.write_bytes(b"glTF" + (2).to_bytes(4, "little") + (12 + len(chunks)).to_bytes(4, "little") + chunks)
    return to


def test_a_file_of_others_is_no_avatar(glb: Path, tmp_path: Path) -> None:
    (tmp_path / "arms.bvh").write_bytes(bvh())
    assert refused(tmp_path / "arms.bvh") == "avatar_not_ours"
    (tmp_path / "half.glb").write_bytes(glb.read_bytes()[: glb.stat().st_size // 2])
    assert refused(tmp_path / "half.glb") == "avatar_not_ours"
    for part in ("skins", "meshes", "materials", "images", "animations"):
        document = Glb(glb).json
        del document[part]
        assert refused(changed(glb, tmp_path / "less.glb", document)) == "avatar_not_ours", part


def test_numbers_that_lead_outside_are_refused(glb: Path, tmp_path: Path) -> None:
    primitive = Glb(glb).json["meshes"][0]["primitives"][0]
    attributes = primitive["attributes"]
    for name, other in (
        ("POSITION", attributes["TEXCOORD_0"]),
        ("JOINTS_0", primitive["indices"]),
        ("WEIGHTS_0", attributes["TEXCOORD_0"]),
        ("TEXCOORD_0", 10_000),
    ):
        document = Glb(glb).json
        document["meshes"][0]["primitives"][0]["attributes"][name] = other
        assert refused(changed(glb, tmp_path / "wrong.glb", document)) == "avatar_not_ours", name
    document = Glb(glb).json
    document["accessors"][primitive["indices"]]["byteOffset"] = -4
    assert refused(changed(glb, tmp_path / "wrong.glb", document)) == "avatar_not_ours"
    document = Glb(glb).json  # as many vertices as three: all others are beyond
    for accessor in (*attributes.values(), *(one["POSITION"] for one in primitive["targets"])):
        document["accessors"][accessor]["count"] = 3
    assert refused(changed(glb, tmp_path / "wrong.glb", document)) == "avatar_not_ours"


def test_a_compressed_one_is_the_same_but_for_rounding(avatar: Avatar, found: Avatar, tmp_path: Path) -> None:
    with Run() as run:
        scene = Scene(built_in("wave", avatar.mesh.skeleton))
        write_avatar(tmp_path, avatar, scene, AvatarOptions(compression="meshopt"), run)
    before, after = found, read_avatar(tmp_path / "avatar.glb")
    assert np.abs(after.mesh.vertices - before.mesh.vertices).max() < 2e-5, "metres"
    rotated = [np.sort(one.mesh.triangles, axis=1) for one in (before, after)]
    assert np.array_equal(*rotated), "each may begin at another of its vertices"
    for one, other in zip(before.morphs, after.morphs, strict=True):
        count = len(before.mesh.vertices)
        assert one.name == other.name
        assert np.abs(one.dense(count) - other.dense(count)).max() < 2e-5, "metres"
    assert np.abs(after.filmed.rotations - before.filmed.rotations).max() < 2e-4
