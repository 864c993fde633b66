"""Mean value coordinates: linear functions are reproduced, corners and edges keep their values."""

from __future__ import annotations

import numpy as np

from engine.geometry.deformation.mean_value_coordinates import mean_value_warp

HOOK = np.array([[0, 0], [6, 0], [6, 4], [4, 4], [4, 2], [2, 2], [2, 5], [0, 5]], float)


def test_linear_functions_come_out_inside_and_outside() -> None:
    points = np.random.default_rng(0).uniform(-2, 8, (500, 2))
    turn = np.array([[0.8, 0.3], [-0.2, 1.1]])
    np.testing.assert_allclose(mean_value_warp(points, HOOK, HOOK @ turn + 3), points @ turn + 3, atol=1e-9)


def test_corners_and_edges_keep_their_values() -> None:
    values = np.random.default_rng(1).normal(size=(8, 3))
    np.testing.assert_allclose(mean_value_warp(HOOK, HOOK, values), values)
    middles = (HOOK + np.roll(HOOK, -1, 0)) / 2
    np.testing.assert_allclose(mean_value_warp(middles, HOOK, values), (values + np.roll(values, -1, 0)) / 2, atol=1e-9)


def test_the_middle_of_a_square_is_the_mean() -> None:
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], float)
    np.testing.assert_allclose(mean_value_warp(np.array([[1.0, 1.0]]), square, np.array([[1.0], [5], [2], [4]])), [[3]])


def test_which_way_round_does_not_matter() -> None:
    points = np.random.default_rng(2).uniform(0, 5, (100, 2))
    values = np.random.default_rng(3).normal(size=(8, 2))
    np.testing.assert_allclose(
        mean_value_warp(points, HOOK, values), mean_value_warp(points, HOOK[::-1], values[::-1]), atol=1e-9
    )
