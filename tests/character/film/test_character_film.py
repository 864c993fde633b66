"""The film of a character: what camera and shadow change of it, against what is known of the scene."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from template_character import still, template_character

from engine.body.fitting.body_fitting import Fit
from engine.character.film.film import WALL_BEHIND_METRES, film
from engine.character.fit.template_fit import FittedBody
from engine.character.rig.measures import pose
from engine.character.rig.rigging import Character
from engine.geometry.camera import Camera
from engine.motion.edit import repeat_loop
from engine.render.lighting.ground_shadow import GroundShadow
from engine.render.scene.camera_moves import ORBIT_DEGREES, PERIOD_SECONDS, SLIDE_SHARE, Move

HEIGHT, WIDTH, FOCAL = 240, 200, 360.0
GREY, GREEN, RED = 150, (20, 220, 20), (230, 20, 20)
DARK = GroundShadow(strength=0.6)


@pytest.fixture(scope="module")
def character() -> Character:
    """Somebody in red, four metres from the camera."""
    mesh = replace(template_character(texture_size=16), texture=np.full((16, 16, 3), RED, np.uint8))
    return Character(mesh, still(mesh.skeleton), np.array([0.0, 1.0, 4.0]))


def filmed(character: Character, move: Move, shadow: GroundShadow = DARK) -> np.ndarray:
    """(2, H, W, 3): the first frame, and the one in which the camera is furthest to the side. There is a green mark on the
    wall, in the middle of which the pixel is (94.5, 29.5)."""
    nowhere = Fit(np.zeros(1, np.float32), np.zeros((1, 3, 3), np.float32), np.zeros(3, np.float32), 0.0, np.zeros(0))
    fitted = FittedBody(
        nowhere, Camera((0, 0, 0), FOCAL, ((WIDTH - 1) / 2, (HEIGHT - 1) / 2), (HEIGHT, WIDTH)), np.zeros(1, np.bool_)
    )
    plate = np.full((HEIGHT, WIDTH, 3), GREY, np.uint8)
    plate[20:40, 85:105] = GREEN
    clip = replace(repeat_loop(character.pictured, 2), fps=4 / PERIOD_SECONDS)
    return np.array(list(film([(character, clip)], fitted, plate, shadow, move, (WIDTH, HEIGHT)))).astype(int)


def middle(shown: np.ndarray) -> np.ndarray:
    return np.argwhere(shown).mean(0)


def person(frame: np.ndarray) -> np.ndarray:
    return frame[..., 0] - frame[..., 2] > 60


def mark(frame: np.ndarray) -> np.ndarray:
    return frame[..., 1] - frame[..., 0] > 60


def test_a_fixed_camera_shows_the_plate_wherever_nobody_is(character: Character) -> None:
    first, later = filmed(character, "fixed", GroundShadow(strength=0))
    np.testing.assert_array_equal(first, later)
    bare = first[..., 0] == first[..., 2]
    assert np.isin(first[bare & ~mark(first)], GREY).all() and mark(first).sum() == 400
    rows, columns = (np.flatnonzero(person(first).any(axis)) for axis in (1, 0))
    body = pose(character, character.pictured)
    away = 4.0 - body[:, 2]
    places = [(WIDTH - 1) / 2 + FOCAL * body[:, 0] / away, (HEIGHT - 1) / 2 - FOCAL * (body[:, 1] - 1) / away]
    ends = [columns[0], columns[-1], rows[0], rows[-1]]
    assert np.abs(np.array([[one.min(), one.max()] for one in places]).ravel() - ends).max() < 1.5


def test_parallax_moves_the_wall_and_not_the_person(character: Character) -> None:
    """A point at the distance d from the camera goes sideways by SLIDE_SHARE f (1 - p / d); the person is at p."""
    first, later = filmed(character, "parallax")
    near = 4.0 - float(character.pictured.root[0, 2])
    expected = SLIDE_SHARE * FOCAL * (1 - near / (4.0 + WALL_BEHIND_METRES))
    np.testing.assert_allclose(middle(mark(later)) - middle(mark(first)), (0, expected), atol=0.5)
    assert np.abs(middle(person(later)) - middle(person(first))).max() < 1.0


def test_an_orbit_turns_about_the_person(character: Character) -> None:
    """In the camera's eyes the wall turns the other way about the upright axis through the person's hips."""
    first, later = filmed(character, "orbit")
    np.testing.assert_array_equal(first, filmed(character, "fixed")[0])
    assert np.abs(middle(person(later)) - middle(person(first))).max() < 3
    far, angle = 4.0 + WALL_BEHIND_METRES, np.radians(ORBIT_DEGREES)
    x = (94.5 - (WIDTH - 1) / 2) / FOCAL * far
    y = ((HEIGHT - 1) / 2 - 29.5) / FOCAL * far
    pivot = character.pictured.root[0]
    away = np.array([x - pivot[0], 4.0 - far - pivot[2]])
    across, deep = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ away
    distance = 4.0 - deep - pivot[2]
    expected = (HEIGHT - 1) / 2 - FOCAL * y / distance, (WIDTH - 1) / 2 + FOCAL * (across + pivot[0]) / distance
    np.testing.assert_allclose(middle(mark(later)), expected, atol=1.0)
    widths = [np.ptp(np.flatnonzero(person(frame).any(0))) for frame in (first, later)]
    assert widths[1] < 0.97 * widths[0], "arms stretched across the view are seen from the side"


def test_the_shadow_darkens_the_ground_at_the_feet_and_nothing_else(character: Character) -> None:
    bare, shaded = (filmed(character, "fixed", shadow)[0] for shadow in (GroundShadow(strength=0), DARK))
    darker = (shaded < bare).any(-1)
    assert (shaded <= bare).all()
    feet = np.flatnonzero(person(bare).any(1))[-1]
    rows = np.flatnonzero(darker.any(1))
    assert rows[0] > feet - 20
    assert shaded[darker, 0].min() < 0.8 * GREY
    whole = (bare == RED).all(-1)
    np.testing.assert_array_equal(shaded[whole], bare[whole])
