"""What is worn once is no pattern to go on with."""

from __future__ import annotations

import numpy as np

from engine.imaging.masks.usual_colours import MIXED_PIXELS, usual_colours


def test_a_badge_is_rare_on_cloth_and_stripes_are_usual() -> None:
    rgb = np.zeros((100, 100, 3), np.uint8)
    rgb[::10], rgb[1::10] = (200, 30, 30), (200, 30, 30)  # a fifth of the cloth
    rgb[40:52, 40:52] = (250, 220, 60)
    usual = usual_colours(rgb, np.ones((100, 100), np.bool_))
    badge = np.zeros((100, 100), np.bool_)
    badge[40 - MIXED_PIXELS : 52 + MIXED_PIXELS, 40 - MIXED_PIXELS : 52 + MIXED_PIXELS] = True
    np.testing.assert_array_equal(usual, ~badge)


def test_where_nothing_is_usual_everything_is() -> None:
    noise = np.random.default_rng(0).integers(0, 256, (80, 80, 3)).astype(np.uint8)
    region = np.zeros((80, 80), np.bool_)
    region[10:60, 10:60] = True
    np.testing.assert_array_equal(usual_colours(noise, region), region)
    assert not usual_colours(noise, np.zeros((80, 80), np.bool_)).any()
