"""Weights by heat: shares of one, halves in the middle, and no heat through a gap."""

from __future__ import annotations

import numpy as np

from engine.character.drawing.bone_heat import bones_nearby, heat_weights, thickness


def test_between_two_bones_of_a_bar_weights_go_over_evenly() -> None:
    bar = np.zeros((21, 101), np.bool_)
    bar[4:17, 5:96] = True
    far = bones_nearby(bar, [np.array([[10, 10], [40, 10]]), np.array([[60, 10], [90, 10]])])
    weights = heat_weights(bar, far.argmin(0), far.min(0), 2)
    np.testing.assert_allclose(weights[bar].sum(1), 1, atol=1e-5)
    assert not weights[~bar].any()
    along = weights[10, 5:96, 0]
    assert (np.diff(along) <= 1e-6).all()
    np.testing.assert_allclose(along, weights[10, 5:96, 1][::-1], atol=0.02)
    assert along[10] > 0.95


def test_nearness_is_counted_within_the_figure() -> None:
    """A U: its two legs are six pixels apart, and the way from one to the other is long."""
    shape = np.zeros((80, 40), np.bool_)
    shape[5:75, 5:17] = shape[5:75, 23:35] = shape[63:75, 5:35] = True
    far = bones_nearby(shape, [np.array([[10, 8], [10, 30]]), np.array([[28, 8], [28, 30]])])
    assert far[0][8, 28] > 90
    weights = heat_weights(shape, far.argmin(0), far.min(0), 2)
    assert weights[8, 16, 0] > 0.99
    assert weights[8, 24, 1] > 0.99


def test_a_bone_beside_the_figure_begins_at_its_nearest_pixel() -> None:
    bar = np.zeros((20, 60), np.bool_)
    bar[5:15, 20:50] = True
    far = bones_nearby(bar, [np.array([[2, 9], [6, 9]])])
    assert far[0][9, 20] == 0
    np.testing.assert_allclose(far[0][9, 40], 20, atol=1e-3)


def test_a_cut_out_is_round_at_its_edge_and_even_inside() -> None:
    disk = np.hypot(*np.mgrid[-50:51, -50:51]) < 45
    half = thickness(disk, 3.0, 10.0)
    assert half[50, 50] == 3
    assert 0 < half[50, 6] < 2
    assert not half[~disk].any()
