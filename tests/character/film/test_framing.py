"""Films in which the person stays in the picture, whatever they do: the whole mesh projected, frame by frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from template_character import still, template_character

from engine.character.film.film import moving_camera
from engine.character.film.motions import MotionChoice, choose_motion
from engine.character.options import BUILT_IN_MOTIONS
from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.geometry.rigging.skeleton import Skeleton
from engine.geometry.rigging.skinning import skin
from engine.motion import rotation
from engine.motion.edit import repeat_loop
from engine.motion.feet.foot_contact import sole_places
from engine.motion.files.source_motion import SourceMotion
from engine.motion.kinematics import pose_transforms
from engine.motion.library import built_in
from engine.motion.rotation import about
from engine.render.scene.camera_moves import CAMERA_MOVES, Move, camera_at

DISTANCE = 4.0


@pytest.fixture(scope="module")
def character() -> Character:
    mesh = template_character(texture_size=16)
    return Character(mesh, still(mesh.skeleton), np.array([0.0, 1.0, DISTANCE]))


def camera(character: Character, above: float, below: float, beside: float = 0.5) -> Camera:
    """A picture 1000 pixels high, in which so much of the height is free above the person's head and below their soles, and
    `beside` of the person's height beside the middle; fewer than none: that much of them is cut off."""
    x, y, z = character.eye.tolist()
    flat = Camera((x, y, z), 1000.0, (0.0, 0.0), (1, 1)).project(posed_at(character, character.pictured, 0))
    top, bottom = flat[:, 1].min(), flat[:, 1].max()
    scale = (1 - above - below) * 1000 / (bottom - top)
    width = round(2 * beside * 1000)
    return Camera((x, y, z), 1000 * scale, ((width - 1) / 2, above * 1000 - top * scale), (1000, width))


def posed_at(character: Character, clip: object, frame: int) -> np.ndarray:
    mesh = character.mesh
    moves = pose_transforms(mesh.skeleton, clip.rotations[[frame]], clip.root[[frame]])[0]  # type: ignore[attr-defined]
    return skin(mesh.vertices, mesh.bones, mesh.weights, moves)


def boxes(character: Character, seen: Camera, clip: object, arms: bool) -> np.ndarray:
    """(F, 2, 2) the least and the largest x and y of the mesh in each frame, with or without arms and hands."""
    mesh = character.mesh
    bone = mesh.bones[np.arange(len(mesh.bones)), mesh.weights.argmax(1)]
    raised = np.array(["Arm" in name or "Hand" in name for name in mesh.skeleton.names])[bone]
    kept = np.ones(len(bone), bool) if arms else ~raised
    points = [seen.project(posed_at(character, clip, f)[kept])[:, :2] for f in range(len(clip.root))]  # type: ignore[attr-defined]
    return np.array([[one.min(0), one.max(0)] for one in points])


def inside(found: np.ndarray, seen: Camera, margin: float = 0.0) -> bool:
    height, width = seen.size
    return bool((found[:, 0] >= margin).all() and (found[:, 1] <= [width - 1 - margin, height - 1 - margin]).all())


def played(character: Character, seen: Camera, name: str, motion: SourceMotion | None = None, fps: float = 5.0):  # type: ignore[no-untyped-def]
    return choose_motion(character, lambda second: seen, character.pictured, MotionChoice(name, motion, (), 4.0, fps))


@pytest.mark.parametrize(("above", "below"), [(0.15, 0.1), (0.01, 0.01)], ids=["room", "tight"])
@pytest.mark.parametrize("name", BUILT_IN_MOTIONS)
def test_head_to_soles_are_in_every_frame_and_all_in_the_last(
    character: Character, name: str, above: float, below: float
) -> None:
    seen = camera(character, above, below)
    film = played(character, seen, name).film
    assert inside(boxes(character, seen, film, arms=False), seen)
    assert inside(boxes(character, seen, film, arms=True)[-1:], seen, margin=5)


def test_nothing_at_all_leaves_a_picture_with_room_for_it(character: Character) -> None:
    seen = camera(character, 0.35, 0.1)
    for name in ("wave", "dance", "walk"):
        assert inside(boxes(character, seen, played(character, seen, name).film, arms=True), seen, margin=10)


def test_the_walk_uses_the_room_that_there_is(character: Character) -> None:
    seen = camera(character, 0.35, 0.35)
    film = played(character, seen, "walk", fps=10.0).film
    assert film.root[-1, 2] - film.root[0, 2] > 0.7, "it comes nearer"
    assert len(film.root) == 40, "for as long as it was asked for"
    assert boxes(character, seen, film, arms=True)[:, 1, 1].max() > 850, "until the picture is filled"


@pytest.mark.parametrize("move", CAMERA_MOVES)
def test_whoever_comes_nearer_stays_in_sight_of_a_camera_that_moves(character: Character, move: Move) -> None:
    """Nearer than what the camera goes around, they are off to the side when it swings."""
    seen = camera(character, 0.3, 0.3, beside=0.3)
    choice = MotionChoice("walk", None, (), 8.0, 5.0)
    film = choose_motion(character, moving_camera(character, seen, move), character.pictured, choice).film
    for frame in range(len(film.root)):
        moved = camera_at(move, seen, character.pictured.root[0], frame / film.fps)
        shown = moved.project(posed_at(character, film, frame))[:, :2]
        height, width = seen.size
        assert (shown >= 0).all() and (shown <= [width - 1, height - 1]).all()


@pytest.mark.parametrize("move", CAMERA_MOVES)
def test_a_group_is_seen_by_one_camera_that_goes_around_the_first(character: Character, move: Move) -> None:
    """Each is in a world of their own: a point of the second is where the film shows it."""
    seen = camera(character, 0.3, 0.3)
    aside = np.array([-0.7, 0.1, 0.4])
    second = replace(character, eye=character.eye + aside)
    own = moving_camera(character, replace(seen, eye=tuple(second.eye.tolist())), move, of=second)
    points = posed_at(character, character.pictured, 0)[::50].astype(np.float64)
    for moment in (0.0, 1.1, 5.0):
        shown = camera_at(move, seen, character.pictured.root[0], moment).project(points - aside)
        assert own(moment).project(points) == pytest.approx(shown, abs=1e-2)


def test_feet_that_the_picture_cuts_off_stay_cut_and_the_head_in_it(character: Character) -> None:
    seen = camera(character, 0.1, -0.3)
    for name in ("walk", "wave"):
        found = boxes(character, seen, played(character, seen, name).film, arms=False)
        assert (found[:, 0, 1] >= 0).all()
        assert found[:, 1, 1].max() <= 1000 * 1.3 + 10, "nothing more is cut off"


def file_of(skeleton: Skeleton, turn: float) -> SourceMotion:
    """A run of eight seconds that keeps its direction, as a motion's file tells it."""
    run = repeat_loop(built_in("run", skeleton), 240)
    turned = about("y", np.radians(turn))
    rotations = run.rotations.astype(np.float64)
    x, y, z = run.root.T.astype(np.float64)
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    offsets = skeleton.offsets().astype(np.float64)
    translations = np.tile(offsets, (240, 1, 1))
    translations[:, 0] = np.stack([c * x + s * z, y, c * z - s * x], 1)
    rotations[:, 0] = rotation.multiply(turned, rotations[:, 0])
    return SourceMotion(
        *("run", 30.0, skeleton.names, skeleton.parents, rotation.identity(len(skeleton.names)), offsets),
        *(np.full((len(skeleton.names), 3), np.nan), rotations, translations, (0.0, 1.0, 0.0), "metre", 1.0),
        loops=False,
    )


@pytest.mark.parametrize("turn", [0.0, 90.0])
def test_whoever_runs_away_by_a_file_of_their_own_stays_too(character: Character, turn: float) -> None:
    """The run turns halfway: where a motion faces in the middle is where it is made to face, so that it is off to the side or
    to the viewer for one half at least."""
    skeleton = character.mesh.skeleton
    straight, aside = file_of(skeleton, 0.0), file_of(skeleton, turn)
    way = straight.translations[120:121, 0] - aside.translations[120:121, 0]
    translations = straight.translations.copy()
    translations[120:, 0] = aside.translations[120:, 0] + way
    rotations = straight.rotations.copy()
    rotations[120:] = aside.rotations[120:]
    motion = replace(straight, rotations=rotations, translations=translations)
    seen = camera(character, 0.1, 0.08)
    film = choose_motion(
        character, lambda second: seen, character.pictured, MotionChoice("", motion, (), 8.0, 8.0)
    ).film
    assert len(film.root) > 50
    assert inside(boxes(character, seen, film, arms=False), seen)
    assert np.ptp(sole_places(skeleton, film)[..., 1].min(2), axis=0).min() > 0.05, "and runs on"


@pytest.mark.parametrize("seconds", [1.0, 6.5])
@pytest.mark.parametrize("name", BUILT_IN_MOTIONS)
def test_a_film_is_as_long_as_it_was_asked_for(character: Character, name: str, seconds: float) -> None:
    """A bow that is done once is over before: its last pose is held."""
    seen = camera(character, 0.15, 0.1)
    film = choose_motion(
        character, lambda second: seen, character.pictured, MotionChoice(name, None, (), seconds, 10.0)
    ).film
    assert len(film.rotations) == len(film.root) == 10 * seconds
