"""Backs as fronts seen through: what only fronts have is off, cloth and its patterns stay."""

from __future__ import annotations

import numpy as np

from engine.character.texture.see_through import front_features, without_front_features

HIGH, WIDE = 200, 80
SUIT, TIE, SHIRT, SKIN, STRIPE = (40, 44, 70), (200, 30, 40), (240, 240, 240), (220, 170, 140), (150, 60, 60)
HEAD, TRUNK, LEGS, FACE = np.zeros((4, HIGH, WIDE), np.bool_)
HEAD[10:40, 30:50] = True
TRUNK[40:120, 15:65] = True
LEGS[120:190, 20:60] = True
FACE[15:35, 33:47] = True


def person(cloth: tuple[int, int, int] = SUIT) -> np.ndarray:
    """A picture (h, w, 3) of somebody all in one cloth, with the grain of cameras."""
    rgb = np.full((HIGH, WIDE, 3), 128)
    rgb[HEAD], rgb[TRUNK | LEGS] = SKIN, cloth
    return np.clip(rgb + np.random.default_rng(3).integers(-3, 4, rgb.shape), 0, 255).astype(np.uint8)


def features(rgb: np.ndarray) -> np.ndarray:
    return front_features(rgb, TRUNK, LEGS, HEAD, FACE).features


def test_a_tie_on_a_shirt_is_the_front_s_alone() -> None:
    rgb = person()
    rgb[40:80, 32:48], rgb[40:80, 37:43] = SHIRT, TIE
    found = features(rgb)
    assert found[42:78, 33:47].all(), "tie and shirt"
    assert not found[90:120].any() and not found[:, :26].any() and not found[:, 54:].any(), "and nothing else"
    back = without_front_features(rgb, TRUNK, LEGS, HEAD, FACE, TRUNK | LEGS | HEAD)
    assert np.abs(back[TRUNK].astype(int) - SUIT).max() < 12, "cloth goes on where they were"
    np.testing.assert_array_equal(back[~TRUNK], rgb[~TRUNK])


def test_plain_cloth_has_no_features() -> None:
    assert not features(person()).any()


def test_stripes_go_round() -> None:
    rgb = person()
    for row in range(44, 120, 8):
        rgb[row : row + 3, 15:65] = STRIPE
    assert not features(rgb).any()


def test_motifs_that_are_at_the_sides_too_are_a_pattern() -> None:
    rgb = person()
    for row in range(46, 116, 10):
        for column in range(17, 63, 7):
            rgb[row : row + 3, column : column + 3] = STRIPE
    assert features(rgb).mean() < 0.02


def test_trousers_are_no_feature_where_the_shirt_ends() -> None:
    rgb = person(SHIRT)
    rgb[100:120, 15:65], rgb[LEGS] = SUIT, SUIT
    assert not features(rgb).any()


def test_bare_shoulders_are_no_cloth_that_goes_round() -> None:
    rgb = person()
    rgb[40:70, 15:27] = rgb[40:70, 53:65] = SKIN
    found = features(rgb)
    assert not found.any(), "the shirt between them stays, and so do they"


def test_cloth_in_the_colour_of_skin_is_cloth() -> None:
    rgb = person(SKIN)
    rgb[60:90, 32:48] = TIE
    assert features(rgb)[61:89, 33:47].all()


def test_a_print_of_any_size_up_to_half_of_the_width() -> None:
    for half in (4, 8, 12):
        rgb = person()
        rgb[70:90, 40 - half : 40 + half] = TIE
        found = features(rgb)
        assert found[71:89, 41 - half : 39 + half].all()


def test_where_the_sides_have_no_light_nothing_is_taken_off() -> None:
    rgb = person(SHIRT)
    rgb[TRUNK & (np.abs(np.arange(WIDE) - 40) > 16)[None]] = (30, 30, 30)
    assert not features(rgb).any()


def test_nobody_has_nothing() -> None:
    empty = np.zeros_like(TRUNK)
    assert not front_features(person(), empty, empty, HEAD, FACE).features.any()
    rgb = person()
    rgb[60:80, 36:44] = TIE
    assert front_features(rgb, TRUNK, LEGS, empty, empty).features[62:78, 37:43].all(), "without a head, either"
