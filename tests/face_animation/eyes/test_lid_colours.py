"""Lids have the lightness of the skin around them, and the hue that the cheeks have where they are as light."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, painted, placed

from engine.face_animation.eyes.lid_colours import (
    BELOW_BROW_VERTICES,
    MAX_OWN_HUE,
    SKIN_BELOW_LID_VERTICES,
    UPPER_LID_STRIPS,
    lid_colours,
    of_one_hue,
)
from engine.imaging.luminance import LUMINANCE_WEIGHTS

FACE = placed(160, (250, 200))
SIZE = (500, 600)
CHEEK = np.array([200.0, 150.0, 130.0])
EVEN_SLOPES = np.ones(3)


def strip(colour: tuple[float, float, float], width: int = 9) -> np.ndarray:
    """(1, width, 3) of one colour."""
    return np.full((1, width, 3), colour, np.float32)


def test_an_even_face_has_lids_of_its_skin() -> None:
    for lid in lid_colours(painted(FACE, SIZE), FACE):
        for end in (lid.above, lid.below):
            np.testing.assert_allclose(end[0].mean(axis=0), SKIN, atol=4)


def test_their_edges_are_as_light_as_the_skin_below_and_their_creases_as_that_above() -> None:
    picture = painted(FACE, SIZE)
    for side in range(2):
        rows = [FACE[list(row), :2] for row in SKIN_BELOW_LID_VERTICES[side]]
        band = np.concatenate([rows[0], rows[1][::-1]]).round().astype(np.int32)
        cv2.fillPoly(picture, [band], [round(0.9 * one) for one in SKIN])
        cv2.polylines(picture, [band], True, [round(0.9 * one) for one in SKIN], 5)
    for lid in lid_colours(picture, FACE):
        above, below = (end[0, end.shape[1] // 2] @ LUMINANCE_WEIGHTS for end in (lid.above, lid.below))
        assert below == pytest.approx(0.9 * above, rel=0.02)


@pytest.mark.parametrize("light", [0.5, 0.8, 1.0])
def test_a_red_socket_is_no_redder_than_the_cheek(light: float) -> None:
    red = strip(tuple(light * CHEEK * (1.3, 0.9, 0.9)))
    (one, other) = of_one_hue([red, red], CHEEK, EVEN_SLOPES)
    np.testing.assert_array_equal(one, other)
    np.testing.assert_allclose(one @ LUMINANCE_WEIGHTS, red @ LUMINANCE_WEIGHTS, rtol=1e-5)
    assert one[0, 0, 0] / one[0, 0, 1] <= CHEEK[0] / CHEEK[1] + 1e-5


def test_shaded_lids_are_as_red_as_shaded_skin() -> None:
    """By hand: at half the light, and slopes of 0.7 and 1.1, red is to green as in the light times 2 to the power of 0.4."""
    slopes = np.array([0.7, 1.1, 1.2])
    usual = CHEEK * 0.5**slopes
    (one, _) = of_one_hue([strip(tuple(usual))] * 2, CHEEK, slopes)
    assert one[0, 0, 0] / one[0, 0, 1] == pytest.approx(CHEEK[0] / CHEEK[1] * 2**0.4, rel=0.03)


def test_both_lids_have_one_hue_in_the_same_light_and_little_of_their_own() -> None:
    blue, yellow = strip((150, 150, 190)), strip((190, 150, 90))
    one, other = of_one_hue([blue, yellow], CHEEK, EVEN_SLOPES)
    np.testing.assert_allclose(
        one / one.sum(axis=2, keepdims=True), other / other.sum(axis=2, keepdims=True), atol=1e-5
    )
    hue = np.log(one[0, 0] / (one[0, 0] @ LUMINANCE_WEIGHTS)) - np.log(CHEEK / (CHEEK @ LUMINANCE_WEIGHTS))
    assert np.abs(hue).max() < 2 * MAX_OWN_HUE


def test_eyes_at_a_picture_s_edge_have_lids_too() -> None:
    face = FACE - np.float32([250, 170, 0])
    for lid in lid_colours(np.full((100, 120, 3), 200, np.uint8), face):
        assert np.isfinite(lid.above).all() and np.isfinite(lid.below).all()


def test_the_rows_of_the_skin_above_lie_above_those_below() -> None:
    for side in range(2):
        heights = [
            FACE[list(row), 1].mean()
            for row in (BELOW_BROW_VERTICES[side], UPPER_LID_STRIPS[side][0], *SKIN_BELOW_LID_VERTICES[side])
        ]
        assert (np.diff(heights) > 0).all()
