"""Skin around an eye is a plane of colours through what is lit."""

from __future__ import annotations

import numpy as np

from engine.avatar.texture.template_texture.lit_skin import LitSkin
from engine.imaging.luminance import LUMINANCE_WEIGHTS


def test_a_brow_and_a_shade_change_nothing_of_the_skin() -> None:
    """A square of a light that falls to the left, the upper third of which is a brow, or in half the light."""
    random = np.random.default_rng(3)
    places = np.column_stack([random.uniform(-0.5, 0.5, (3000, 2)), np.zeros(3000)])
    true = np.array([180.0, 135, 115]) + places[:, :1] * [20.0, 15, 12]
    shown = true + random.normal(0, 2, true.shape)
    upper = places[:, 1] > 0.16
    light = float(np.median(true @ LUMINANCE_WEIGHTS))
    shown[upper & (places[:, 0] < 0)] = (45, 32, 25)
    shown[upper & (places[:, 0] >= 0)] *= 0.5
    found = LitSkin.around(shown, places, light)
    np.testing.assert_allclose(found.at(places), true, atol=6)


def test_what_is_trusted_is_as_light_as_skin() -> None:
    skin = LitSkin(np.zeros((4, 3)), np.array([[0.0] * 3, [255.0] * 3]), 100.0)
    trust = skin.trust(np.repeat([[100.0], [58.0], [30.0]], 3, axis=1))
    assert trust[0] == 1 and 0.3 < trust[1] < 0.7 and trust[2] == 0


def test_colours_that_are_continued_stay_among_those_that_are_seen() -> None:
    places = np.column_stack([np.linspace(-0.5, 0.5, 101), np.zeros((101, 2))])
    shown = 150 + 80 * places[:, :1] * np.ones(3)
    found = LitSkin.around(shown, places, 150.0)
    assert found.at(np.array([[5.0, 0, 0]])).max() <= shown.max()
