"""A layer carried on beyond its picture's border."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.face_animation.warping.layers import beyond_border
from engine.imaging.window import Window


def head(top: int, colour: tuple[int, int, int] = (90, 60, 30)) -> NDArray[np.uint8]:
    """A round head of radius 60, its top in row `top`, over a body that the lower border cuts."""
    layer = np.zeros((240, 200, 4), np.uint8)
    layer[..., :3] = colour
    alpha = np.zeros((240, 200), np.uint8)
    cv2.circle(alpha, (100, top + 60), 60, 255, -1)
    alpha[200:, 40:160] = 255
    layer[..., 3] = alpha
    return layer


def test_the_picture_stays_as_it_is_and_a_body_goes_on_straight() -> None:
    layer = head(20)
    more, margin = beyond_border(layer)
    assert margin > 20
    np.testing.assert_array_equal(more[margin:-margin, margin:-margin], layer)
    np.testing.assert_array_equal(more[-1, :, 3], more[-margin - 1, :, 3])
    assert not more[:margin, ..., 3].any()  # nothing cuts the head


@pytest.mark.parametrize("top", [-4, -12, -25])
def test_a_head_that_is_cut_closes_as_the_circle_it_is(top: int) -> None:
    more, margin = beyond_border(head(top))
    rows = np.flatnonzero((more[:margin, :, 3] > 127).any(axis=1))
    assert margin - rows.min() == pytest.approx(-top, abs=0.2 * -top + 2)


def test_what_is_cut_at_both_corners_goes_on_over_the_whole_width() -> None:
    layer = head(20)
    layer[..., 3] = 255
    more, _ = beyond_border(layer)
    assert (more[..., 3] == 255).all()
    assert (more[..., :3] == layer[0, 0, :3]).all()


def test_within_a_frame_it_goes_on_from_the_inner_picture() -> None:
    layer = head(-12)
    framed = cv2.copyMakeBorder(layer, 25, 15, 3, 2, cv2.BORDER_CONSTANT, value=(255, 255, 255, 0))
    inner = Window(3, 25, 3 + 200, 25 + 240)
    alone, beside = beyond_border(layer)
    more, margin = beyond_border(framed, inner)
    shift = margin + 25 - beside, margin + 3 - beside
    np.testing.assert_array_equal(more[shift[0] :, shift[1] :][: len(alone), : alone.shape[1]], alone)


def test_lace_in_the_hair_that_is_cut_leaves_no_gap_in_the_cap() -> None:
    laced = head(-25)
    laced[:4, 118:122, 3] = 0
    more, margin = beyond_border(laced)
    whole, _ = beyond_border(head(-25))
    np.testing.assert_array_equal(more[: margin - 2], whole[: margin - 2])
