"""Cheapest paths, against all that there are."""

from __future__ import annotations

from itertools import product

import numpy as np

from engine.character.shell.colours.seam_path import cheapest_path, sides_cost


def test_no_path_is_cheaper() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        cost = random.random((5, 4))

        def total(path: tuple[int, ...], cost: np.ndarray = cost) -> float:
            steps = np.abs(np.diff(path))
            return float(cost[np.arange(5), path].sum() + 0.1 * steps.sum()) if steps.max() <= 1 else np.inf

        found = cheapest_path(cost, 1, 0.1)
        assert total(tuple(found)) == min(total(path) for path in product(range(4), repeat=5))


def test_a_path_stays_straight_where_nothing_calls_it_away() -> None:
    cost = np.ones((9, 7))
    cost[:, 3] = 0.5
    assert (cheapest_path(cost, 2, 0.2) == 3).all()


def test_each_side_pays_for_what_it_holds() -> None:
    found = sides_cost(np.array([[1.0, 2, 4]]), np.array([[10.0, 20, 40]]), np.array([[0.1, 0.2, 0.3]]))
    np.testing.assert_allclose(found, [[70.1, 61.2, 43.3, 7]])
