"""Smooth functions over grids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.avatar.attachments.between_grid_points import between_grid_points


def test_a_linear_function_is_itself_between_the_points_that_are_asked() -> None:
    cells = np.argwhere(np.random.default_rng(0).random((9, 12, 7)) < 0.3)
    asked = []

    def linear(places: NDArray[np.float64]) -> NDArray[np.float64]:
        asked.append(len(places))
        return places @ [0.5, -2.0, 3.0] + 1

    np.testing.assert_allclose(between_grid_points(cells, linear), linear(cells.astype(np.float64)))
    assert asked[0] <= 6 * 7 * 5  # every second along each axis, and one more at the end


def test_of_no_cells_nothing_is_asked() -> None:
    assert len(between_grid_points(np.zeros((0, 3), int), lambda places: places[5])) == 0
