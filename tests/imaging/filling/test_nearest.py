"""The nearest pixel of a mask, against looking at every one."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.nearest import nearest_colours, nearest_in, nearest_values


def test_none_is_much_nearer_than_the_one_that_is_found() -> None:
    mask = np.random.default_rng(3).random((40, 60)) < 0.02
    rows, columns = nearest_in(mask)
    ys, xs = np.mgrid[:40, :60]
    found = np.hypot(rows - ys, columns - xs)
    all_of_them = np.argwhere(mask)
    least = np.hypot(*(np.stack([ys, xs], -1)[:, :, None] - all_of_them).transpose(3, 0, 1, 2)).min(-1)
    assert mask[rows, columns].all()
    np.testing.assert_allclose(found, least, rtol=0.05)


def test_within_the_mask_each_is_its_own() -> None:
    mask = np.zeros((9, 7), np.bool_)
    mask[2:6, 1:5] = True
    rows, columns = nearest_in(mask)
    ys, xs = np.nonzero(mask)
    assert (rows[mask] == ys).all() and (columns[mask] == xs).all()
    assert (rows[4, 6], columns[4, 6]) == (4, 4) and (rows[8, 2], columns[8, 2]) == (5, 2)


def test_an_empty_mask_leaves_the_first_pixel() -> None:
    rows, columns = nearest_in(np.zeros((4, 5), np.bool_))
    assert not rows.any() and not columns.any()


def test_colours_are_those_of_the_nearest() -> None:
    rng = np.random.default_rng(5)
    rgb, own = rng.integers(0, 256, (40, 60, 3), dtype=np.uint8), rng.random((40, 60)) < 0.05
    np.testing.assert_array_equal(nearest_colours(rgb, own), rgb[nearest_in(own)])


def test_values_of_any_shape_are_those_of_the_nearest() -> None:
    rng = np.random.default_rng(7)
    values, known = rng.random((30, 20, 2)), rng.random((30, 20)) < 0.05
    np.testing.assert_array_equal(nearest_values(values, known), values[nearest_in(known)])
