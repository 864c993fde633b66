"""Distances and growth of masks, in cases counted by hand."""

from __future__ import annotations

import numpy as np

from engine.imaging.masks.mask_distance import dilate_mask, distance_inside, distance_to


def square() -> np.ndarray:
    mask = np.zeros((9, 11), np.bool_)
    mask[2:7, 3:8] = True
    return mask


def test_the_middle_of_a_square_is_furthest_inside() -> None:
    found = distance_inside(square())
    np.testing.assert_allclose(found[4, 3:8], [1, 2, 3, 2, 1], atol=1e-5)
    assert not found[~square()].any()


def test_beyond_the_picture_is_outside() -> None:
    np.testing.assert_allclose(distance_inside(np.ones((5, 7), np.bool_))[2], [1, 2, 3, 3, 3, 2, 1], atol=1e-5)


def test_how_far_a_mask_is() -> None:
    np.testing.assert_allclose(distance_to(square())[4], [3, 2, 1, 0, 0, 0, 0, 0, 1, 2, 3], atol=1e-5)


def test_a_mask_grows_by_pixels_in_each_direction() -> None:
    wide = np.zeros((9, 11), np.bool_)
    wide[0:9, 1:10] = True
    np.testing.assert_array_equal(dilate_mask(square(), 2), wide)
    assert dilate_mask(np.zeros((3, 3), np.bool_), 1).sum() == 0
