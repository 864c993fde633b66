"""The clips a character is written with: the chosen motion, and all other built-in ones for whoever plays the file."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from template_character import still, template_character

from engine.character.film.motions import MotionChoice, Played, choose_motion
from engine.character.pipeline import MAX_GLB_BYTES, write_small_glb
from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.geometry.rigging.skeleton import Skeleton
from engine.motion import rotation
from engine.motion.clip import Clip
from engine.motion.edit import loop_travel
from engine.motion.feet.foot_contact import sinking_depth, sole_places
from engine.motion.kinematics import joint_places
from engine.motion.library import CLIPS
from engine.run import Run

sys.path.insert(0, str(Path(__file__).parents[1] / "export"))
from glb_reader import Glb, validate

STANDING = ("idle", "jump", "sit", "wave", "dance", "bow")
WRITTEN = {*STANDING, "walk_in_place", "run_in_place"}
LOOPS = {"idle", "dance", "walk_in_place", "run_in_place"}


@pytest.fixture(scope="module")
def character() -> Character:
    mesh = template_character(texture_size=64)
    return Character(mesh, still(mesh.skeleton), np.array([0.0, 1.0, 4.0]))


def chosen(character: Character, name: str, kept: tuple[str, ...] = (), fps: float = 30.0) -> Played:
    seen = Camera((0.0, 1.0, 4.0), 1500.0, (499.5, 499.5), (1000, 1000))
    return choose_motion(character, lambda second: seen, character.pictured, MotionChoice(name, None, kept, 1.0, fps))


@pytest.fixture(scope="module")
def glb(character: Character, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("written") / "character.glb"
    with Run() as run:
        write_small_glb(path, character.mesh, chosen(character, "bow").all, run)
    return path


def read_clip(glb: Glb, skeleton: Skeleton, name: str) -> Clip:
    """An animation as the clip it is: the last key of a loop, its first again, included."""
    animation = glb.animation(name)
    keys = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        target = (glb.names[channel["target"]["node"]], channel["target"]["path"])
        keys[target] = (glb.array(sampler["input"])[:, 0], glb.array(sampler["output"]))
    times, root = keys["Hips", "translation"]
    rotations = np.tile(np.array([0, 0, 0, 1], np.float32), (len(times), len(skeleton.names), 1))
    for joint, bone in enumerate(skeleton.names):
        if (bone, "rotation") in keys:
            rotations[:, joint] = keys[bone, "rotation"][1]
    return Clip(name, (len(times) - 1) / float(times[-1]), rotations, root, "extras" in animation)


@pytest.mark.parametrize("name", CLIPS)
def test_every_built_in_motion_is_written_after_the_chosen_one(character: Character, name: str) -> None:
    names = [clip.name for clip in chosen(character, name).all]
    assert names[:4] == ["pictured", "step_out", name, f"{name}_in_place"]
    assert len(names) == len(set(names))
    assert set(names) >= WRITTEN
    assert sum(one.endswith("_in_place") for one in names[4:]) == 2 - (name in ("walk", "run"))


def test_the_file_is_sound_and_small(glb: Path) -> None:
    assert validate(glb)["messages"] == []
    assert {one["name"] for one in Glb(glb).json["animations"]} >= WRITTEN
    assert glb.stat().st_size < MAX_GLB_BYTES / 3


@pytest.mark.parametrize("name", sorted(WRITTEN))
def test_feet_stand_on_the_ground_and_loops_close(glb: Path, character: Character, name: str) -> None:
    skeleton = character.mesh.skeleton
    clip = read_clip(Glb(glb), skeleton, name)
    assert clip.loops is (name in LOOPS)
    points = sole_places(skeleton, clip)
    assert sinking_depth(points) < 0.01
    assert points[..., 1].min() < 0.002
    if name in STANDING:  # who walks in place walks as on a treadmill
        low = points[:, :, :2, 1].min(-1) < 0.002
        steps = np.linalg.norm(np.diff(points[:, :, :2][..., [0, 2]], axis=0), axis=-1).min(-1)
        assert steps[1:-1][low[1:-2] & low[2:-1] & low[:-3] & low[3:]].max(initial=0) < 0.001
    if clip.loops:
        places = joint_places(skeleton, clip)
        np.testing.assert_allclose(places[-1], places[0], atol=2e-4)
        speed = np.linalg.norm(np.diff(places, axis=0), axis=-1).max(-1)
        assert speed[-1] < 1.05 * speed.max()
        assert np.linalg.norm(loop_travel(Clip(name, clip.fps, clip.rotations[:-1], clip.root[:-1], True))) < 0.01


def test_what_is_kept_is_kept_in_all_of_them(character: Character) -> None:
    arm = character.mesh.skeleton.index("LeftArm")
    for clip in chosen(character, "bow", kept=("arms",)).all:
        turned = rotation.multiply(rotation.inverse(character.pictured.rotations[0, arm]), clip.rotations[:, arm])
        assert rotation.angle(turned).max() < 1e-3, clip.name


def test_others_are_as_fine_and_no_larger_whatever_rate_the_film_has(character: Character) -> None:
    rates = {fps: {clip.name: clip.fps for clip in chosen(character, "bow", fps=fps).all} for fps in (10.0, 60.0)}
    assert all(rates[fps]["bow"] == fps for fps in rates)
    assert all(rates[fps][name] == 30.0 for fps in rates for name in WRITTEN - {"bow"})
