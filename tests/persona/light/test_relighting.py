"""Lights of a collection, and a persona in another one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.persona.collection.face_photo import FacePhoto
from engine.persona.learning import learn_persona
from engine.persona.light.directions import directed_light
from engine.persona.light.relighting import in_light, relit
from engine.persona.persona import Persona

Collection = tuple[np.ndarray, list[np.ndarray]]


@pytest.fixture(scope="module")
def lit(collection: Collection) -> Persona:
    """A third of the photographs is lit from the left, a third from the right."""
    meshes, photos = collection
    shades = [np.linspace(1 + side, 1 - side, photos[0].shape[1])[None, :, None] for side in (0.5, 0.0, -0.5)]
    lit = [np.clip(0.8 * photo * shades[k % 3], 0, 255).astype(np.uint8) for k, photo in enumerate(photos)]
    persona = learn_persona(meshes, lambda number: lit[number], (122, 97)).persona
    return replace(persona, portrait=FacePhoto(lit[1], meshes[1].astype(np.float32), 1))


def sides(persona: Persona, texture: np.ndarray) -> float:
    """Logarithm of the light on the left half of the face over that on its right one."""
    face, middle = persona.frame.face, persona.frame.size[1] // 2
    left, right = (texture[:, half][face[:, half]].mean() for half in (slice(None, middle), slice(middle, None)))
    return float(np.log(left / right))


def test_photographs_that_are_lit_from_a_side_tell_its_light(lit: Persona) -> None:
    for direction, sign in (("left", 1), ("right", -1)):
        light = directed_light(lit, direction)
        assert sign * sides(lit, light.gain) > 0.1 and light.strength > 0.12
        assert abs(np.log(light.gain[lit.frame.face]).mean()) < 1e-4, "neither lighter nor darker as a whole"


def test_a_persona_is_brought_into_the_light(lit: Persona) -> None:
    rest = sides(lit, lit.average)
    for direction, sign in (("left", 1), ("right", -1)):
        other, _ = in_light(lit, direction)
        assert sign * (sides(other, other.average) - rest) > 0.1
        assert lit.portrait is not None and other.portrait is not None
        x, y = np.rint(lit.portrait.mesh[1, :2]).astype(int)
        was, now = (one.rgb[y - 40 : y + 40].astype(float) for one in (lit.portrait, other.portrait))
        turned = np.log(now[:, x - 40 : x].mean() / now[:, x : x + 40].mean())
        turned -= np.log(was[:, x - 40 : x].mean() / was[:, x : x + 40].mean())
        assert sign * turned > 0.02, "the photograph that acts, too"


def test_its_own_light_changes_nothing(lit: Persona) -> None:
    even, strength = in_light(replace(lit, portrait=None), "average")
    np.testing.assert_array_equal(even.colours, lit.colours)
    assert strength == 1.0 and even.portrait is None


def test_a_light_reaches_no_wall(lit: Persona) -> None:
    photo = lit.portrait
    assert photo is not None
    large = np.full((1200, 1200, 3), 90, np.uint8)
    large[: photo.rgb.shape[0], : photo.rgb.shape[1]] = photo.rgb
    made = relit(lit, replace(photo, rgb=large), 0.6 * lit.average.astype(np.float32))
    x, y = np.rint(photo.mesh[1, :2]).astype(int)
    assert made[y, x].mean() < 0.8 * large[y, x].mean()
    np.testing.assert_allclose(made[-50:, -50:], 90, atol=0.5)
