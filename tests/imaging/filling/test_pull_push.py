"""What is not known of a picture, continued from what is."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.pull_push import pull_push

SIZE = (61, 83)


def picture() -> np.ndarray:
    ys, xs = np.mgrid[0 : 1 : SIZE[0] * 1j, 0 : 1 : SIZE[1] * 1j]
    return np.stack([50 + 100 * xs, 200 - 80 * ys, 100 + 0 * xs], -1).astype(np.float32)


def test_what_is_known_stays() -> None:
    weight = np.random.default_rng(0).random(SIZE) > 0.5
    found = pull_push(picture(), weight)
    np.testing.assert_allclose(found[weight], picture()[weight], atol=1e-3)


def test_one_colour_is_continued_everywhere() -> None:
    weight = np.zeros(SIZE)
    weight[20:30, 40:44] = 1
    found = pull_push(np.full((*SIZE, 3), (30.0, 90.0, 210.0)), weight)
    assert np.abs(found - (30, 90, 210)).max() < 0.01


def test_a_hole_in_a_slope_is_filled_near_the_slope() -> None:
    weight = np.ones(SIZE)
    weight[20:40, 30:55] = 0
    garbage = picture()
    garbage[weight == 0] = 255
    found = pull_push(garbage, weight)
    off = np.abs(found - picture())[weight == 0]
    assert off.mean() < 4 and off.max() < 16, "of a slope of 30 across the hole"


def test_nothing_is_made_of_nothing() -> None:
    assert np.abs(pull_push(picture(), np.zeros(SIZE))).max() == 0
