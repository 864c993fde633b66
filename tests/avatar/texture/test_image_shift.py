"""Smooth shifts of a picture's places."""

from __future__ import annotations

import numpy as np

from engine.avatar.texture.image_shift import ImageShift

SIZE = (61, 41)


def bent() -> ImageShift:
    """Bilinear between nodes 20 pixels apart, of which one is moved by (4, -2)."""
    shift = ImageShift.none(SIZE, 20)
    shift.nodes[1, 1] = [4, -2]
    return shift


def test_none_moves_nothing_and_keeps_what_stands_behind() -> None:
    places = np.array([[3.5, 7.25, 2.0], [-4.0, 90.0, -1.0], [np.nan, 1.0, 1.0]], np.float32)
    np.testing.assert_array_equal(ImageShift.none(SIZE, 13).shifted(places), places)


def test_between_nodes_it_is_bilinear_and_beyond_the_last_it_goes_on() -> None:
    moved = bent().shifted(np.array([[20, 20], [10, 20], [30, 30], [5, 5], [20, -50]], np.float32))
    np.testing.assert_allclose(moved, [[24, 18], [12, 19], [31, 29.5], [5.25, 4.875], [20, -50]])


def test_it_is_the_same_on_a_finer_lattice_and_grows_with_the_picture() -> None:
    places = np.random.default_rng(0).uniform(0, 40, (50, 2)).astype(np.float32)
    there = bent().shifted(places)
    np.testing.assert_allclose(bent().finer(SIZE, 5).shifted(places), there, atol=1e-4)
    np.testing.assert_allclose(bent().scaled(3).shifted(3 * places), 3 * there, atol=1e-4)
