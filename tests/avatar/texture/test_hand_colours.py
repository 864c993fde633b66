"""Whose colours a painted hand takes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.template_surface import TemplateSurface, template_surface
from engine.avatar.texture.template_texture.hand_colours import face_skin
from engine.body.rig import HUMAN_RIG
from engine.body.template import load_rig, load_template
from engine.imaging.histogram_matching import to_lab
from engine.performances.modelling.skin_tone import hand_tone, toned
from engine.render.textures.texture_bake import texel_raster

PALE, BROWN, TANNED = (215, 175, 155), (95, 62, 48), (195, 152, 128)
BLUE, BLACK, WHITE = (60, 90, 160), (25, 25, 28), (225, 222, 215)


def some(colour: tuple[int, int, int], count: int = 400, spread: float = 4, seed: int = 0) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).normal(colour, spread, (count, 3)).clip(0, 255).astype(np.uint8)


def lab(colour: tuple[int, int, int]) -> NDArray:
    return to_lab(np.array(colour))[0]


def all_of(colours: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return np.ones(len(colours), np.bool_)


def test_a_sleeve_and_a_wall_seen_beside_the_hand_give_it_nothing() -> None:
    for skin in (PALE, BROWN):
        hand = np.concatenate([some(BLUE), some(WHITE, seed=1)])
        tone = hand_tone(some(skin), hand, all_of(hand), some(BLUE, seed=2))
        assert tone is not None and np.linalg.norm(tone - lab(skin)) < 2


def test_a_hand_that_is_seen_has_a_tone_between_its_own_and_the_face_s() -> None:
    hand = np.concatenate([some(TANNED), some(BLUE, 600)])
    tone = hand_tone(some(PALE), hand, all_of(hand), some(BLUE, seed=2))
    assert tone is not None
    np.testing.assert_allclose(tone, (lab(TANNED) + lab(PALE)) / 2, atol=1.5)


def test_gloves_stay_and_half_of_one_is_none() -> None:
    hand = some(BLACK)
    assert hand_tone(some(PALE), hand, all_of(hand), some(BLUE)) is None
    assert hand_tone(some(PALE)[:0], hand, all_of(hand), some(BLACK, seed=3)) is None  # a helmet, too
    few = np.arange(len(hand)) < 0.1 * len(hand)
    tone = hand_tone(some(PALE), hand, few, some(BLUE))
    assert tone is not None and np.linalg.norm(tone - lab(PALE)) < 2


def test_what_is_painted_keeps_its_own_differences() -> None:
    painted = np.concatenate([some(PALE, 50, 1), some((190, 130, 120), 30, 1)]).astype(np.float32)
    found = toned(painted, lab(BROWN))
    np.testing.assert_allclose(np.median(to_lab(found), 0), lab(BROWN), atol=0.5)
    np.testing.assert_allclose(to_lab(found) - to_lab(found)[0], to_lab(painted) - to_lab(painted)[0], atol=1.0)


def test_cheeks_and_nose_tell_of_skin_and_a_helmet_does_not() -> None:
    surface: TemplateSurface = template_surface(load_template(), load_rig(HUMAN_RIG))
    raster = texel_raster(surface.atlas, 512)
    places = np.einsum("hwk,hwkd->hwd", raster.barycentrics, surface.rest[surface.triangles[raster.triangle]])
    seen = raster.triangle >= 0
    beard = (places[..., 1] < 0.672) & (places[..., 1] > 0.6)
    brows = places[..., 1] > 0.737
    texture = np.where((beard | brows)[..., None], np.uint8(BLACK), np.uint8(PALE)).astype(np.uint8)
    found = face_skin(texture, seen, surface, raster)
    assert len(found) > 50 and (found == PALE).all()
    assert not len(face_skin(texture, np.zeros_like(seen), surface, raster))
    assert not len(face_skin(np.full_like(texture, 40), seen, surface, raster))
