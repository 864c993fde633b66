"""The colours that a picture's own skin has in the shade."""

from __future__ import annotations

import numpy as np
import pytest

from engine.face_animation.shading_colour import CHANNEL_SLOPE_RANGE, FLOOR_GREY_LEVELS, shading_slopes
from engine.imaging.luminance import LUMINANCE_WEIGHTS

SKIN = np.array([220.0, 170.0, 140.0])


def shaded(slopes: np.ndarray, skin: np.ndarray = SKIN) -> np.ndarray:
    """Skin that darkens from left to right by a quarter of its luminance, each channel by its slope."""
    light = np.linspace(0, np.log(0.75), 120)[None, :, None] * np.ones((100, 1, 1))
    return np.rint((skin + FLOOR_GREY_LEVELS) * np.exp(light * slopes) - FLOOR_GREY_LEVELS).astype(np.uint8)


def test_the_slopes_of_a_known_shading_are_found() -> None:
    known = np.array([0.7, 1.1, 1.26])
    known = known / (known @ LUMINANCE_WEIGHTS)
    assert shading_slopes(shaded(known), np.ones((100, 120)), 40) == pytest.approx(known, abs=0.03)


def test_black_and_white_stays_so() -> None:
    found = shading_slopes(shaded(np.ones(3), np.full(3, 180.0)), np.ones((100, 120)), 40)
    assert found == pytest.approx(np.ones(3), abs=1e-3)


def test_what_is_no_skin_or_lies_in_the_dark_has_no_say() -> None:
    picture = shaded(np.ones(3))
    picture[:, :40] = (30, 20, 200)  # a blue thing
    picture[80:] = (25, 5, 5)  # hair
    skin = np.ones((100, 120))
    skin[:, :52] = 0  # the smoothing reaches over its edge
    assert shading_slopes(picture, skin, 40) == pytest.approx(np.ones(3), abs=0.1)


@pytest.mark.parametrize("skin", [np.zeros((100, 120)), np.ones((100, 120))], ids=["no skin", "even skin"])
def test_without_shading_to_be_seen_channels_are_alike(skin: np.ndarray) -> None:
    np.testing.assert_array_equal(shading_slopes(np.full((100, 120, 3), SKIN, np.uint8), skin, 40), np.ones(3))


def test_a_coloured_light_from_one_side_does_not_run_away() -> None:
    picture = np.zeros((100, 120, 3), np.uint8)
    picture[..., 0], picture[..., 1], picture[..., 2] = 200, 150, np.linspace(60, 250, 120)
    found = shading_slopes(picture, np.ones((100, 120)), 40)
    np.testing.assert_array_equal(found, np.clip(found, *np.asarray(CHANNEL_SLOPE_RANGE, np.float32)))
    assert found[2] == pytest.approx(CHANNEL_SLOPE_RANGE[1][2])
