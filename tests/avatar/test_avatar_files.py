"""An avatar's files: judged by Khronos' validator, with everything that engines and talking heads look for."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from glb_reader import Glb, validate
from template_avatar import fitted_template, template_avatar

from engine.avatar.acting import Scene
from engine.avatar.avatar import Avatar, assemble
from engine.avatar.combined_targets import COMBINED_TARGETS
from engine.avatar.mesh import surface_of
from engine.avatar.options import MAX_TEMPLATE_TRIANGLES, AvatarOptions
from engine.avatar.worn import no_attachments
from engine.avatar.writing import WrittenCameras, write_avatar, write_cameras
from engine.body.face.visemes import VISEMES
from engine.body.rig import HUMAN_RIG
from engine.body.template import FACE_UNITS, load_rig, load_template
from engine.geometry.camera import Camera
from engine.geometry.rigging.morph_target import MorphTrack
from engine.motion.library import built_in
from engine.run import Run

NAMES = [*FACE_UNITS, *VISEMES, *COMBINED_TARGETS]


@pytest.fixture(scope="module")
def avatar() -> Avatar:
    return template_avatar(64)


@pytest.fixture(scope="module")
def folder(avatar: Avatar, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files of an avatar that opens its mouth while it waves."""
    out = tmp_path_factory.mktemp("avatar")
    clip = built_in("wave", avatar.mesh.skeleton)
    track = MorphTrack(("jawOpen",), np.linspace(0, 1, len(clip.rotations), dtype=np.float32)[:, None])
    with Run() as run:
        write_avatar(out, avatar, Scene(clip, track), AvatarOptions(vrm=True, levels=1), run)
    return out


def test_the_validator_finds_no_fault(folder: Path) -> None:
    for name in ("avatar.glb", "avatar.vrm"):
        found = validate(folder / name)
        assert [one for one in found["messages"] if one["severity"] == 0] == [], name


def test_it_has_all_targets_by_name_fingers_jaw_and_eyes(folder: Path) -> None:
    glb = Glb(folder / "avatar.glb")
    assert glb.json["meshes"][0]["extras"]["targetNames"] == NAMES
    joints = {glb.nodes[node]["name"] for node in glb.json["skins"][0]["joints"]}
    assert {"LeftHandIndex3", "RightHandPinky3", "Jaw", "LeftEye", "RightEye"} <= joints
    assert len(glb.triangles()) == MAX_TEMPLATE_TRIANGLES
    names = [animation["name"] for animation in glb.json["animations"]]
    assert names[:2] == ["wave", "filmed"] and len(names) == len(set(names)) == 9


def test_the_face_acts_in_the_clip_that_was_asked_for(folder: Path) -> None:
    glb = Glb(folder / "avatar.glb")
    animation = glb.animation("wave")
    (channel,) = [one for one in animation["channels"] if one["target"]["path"] == "weights"]
    weights = glb.array(animation["samplers"][channel["sampler"]]["output"]).reshape(-1, len(NAMES))
    assert weights[-1, NAMES.index("jawOpen")] == pytest.approx(1)
    assert np.delete(weights, NAMES.index("jawOpen"), axis=1).max() == 0


def test_fewer_triangles_keep_the_expressions_of_the_vertices_that_stay(avatar: Avatar) -> None:
    fitted = fitted_template()
    few = assemble(load_template(), load_rig(HUMAN_RIG), fitted, no_attachments(), avatar.mesh.texture, 9000)
    assert 8000 < len(few.mesh.triangles) <= 9000
    surface = surface_of(load_template())
    jaw = NAMES.index("jawOpen")
    moved = few.mesh.vertices + few.morphs[jaw].dense(len(few.mesh.vertices))
    whole = fitted.rest[surface.vertex_of] + fitted.expressions["jawOpen"][surface.vertex_of]
    nearest = np.linalg.norm(moved[::50, None] - whole[None], axis=2).min(1)
    assert nearest.max() < 1e-5  # each stands where a vertex of the whole mesh does, with the mouth open, too


def test_cameras_see_a_point_where_their_matrices_say(tmp_path: Path) -> None:
    camera = Camera((0.3, 1.2, 2.5), 900.0, (359.5, 639.5), (1280, 720), distortion=(0.1, -0.02, 0, 0, 0)).aimed(
        (0.3, 1.2, 2.5), (0, 1, 0)
    )
    write_cameras(tmp_path / "cameras.json", [WrittenCameras("body", [12], [0.4], [camera])])
    (one,) = json.loads((tmp_path / "cameras.json").read_text())["body"]
    point = np.array([0.1, 0.9, 0.2])
    x, y, z = np.array(one["rotation"]) @ point + one["translation"]
    k1, k2 = one["distortion"][:2]
    squared = (x / z) ** 2 + (y / z) ** 2
    bent = 1 + k1 * squared + k2 * squared**2
    pixel = np.array(one["intrinsics"]) @ [x / z * bent, y / z * bent, 1]
    assert pixel[:2] == pytest.approx(camera.project(point[None])[0, :2], abs=0.01)
    assert (one["frame"], one["second"], one["size"]) == (12, 0.4, [720, 1280])
