"""Expansion moves against all labellings of small graphs, and what a picture's labels must do."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from engine.geometry.graph_cut import alpha_expansion, energy, grid_edges


@pytest.mark.parametrize("seed", range(6))
def test_two_labels_are_the_best_there_are(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((3, 4), np.bool_))
    unary, weights = random.uniform(0, 3, (12, 2)), random.uniform(0, 2, len(edges))
    best = min(energy(unary, edges, weights, np.array(labels)) for labels in product(range(2), repeat=12))
    found = alpha_expansion(unary, edges, weights, np.zeros(12, int))
    assert energy(unary, edges, weights, found) == pytest.approx(best, abs=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_three_labels_are_within_twice_the_best(seed: int) -> None:
    """The bound of Boykov, Veksler and Zabih for the Potts model; in fact nearly the best."""
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((2, 4), np.bool_))
    unary, weights = random.uniform(0, 3, (8, 3)), random.uniform(0, 2, len(edges))
    best = min(energy(unary, edges, weights, np.array(labels)) for labels in product(range(3), repeat=8))
    found = energy(unary, edges, weights, alpha_expansion(unary, edges, weights, np.zeros(8, int)))
    assert best - 1e-6 <= found <= 1.1 * best


def test_without_neighbours_each_takes_its_cheapest() -> None:
    unary = np.random.default_rng(1).uniform(0, 1, (50, 5))
    found = alpha_expansion(unary, np.empty((0, 2), int), np.empty(0), np.zeros(50, int))
    np.testing.assert_array_equal(found, unary.argmin(1))


def test_a_speck_is_swallowed_by_what_surrounds_it() -> None:
    mask = np.ones((9, 9), np.bool_)
    edges, lengths = grid_edges(mask)
    unary = np.zeros((81, 2))
    unary[:, 1] = 1.0
    unary[40] = [2.0, 0.0]
    assert alpha_expansion(unary, edges, 1 / lengths, np.zeros(81, int)).sum() == 0
    assert alpha_expansion(unary, edges, 0.1 / lengths, np.zeros(81, int)).sum() == 1


def test_a_full_grid_has_all_its_edges() -> None:
    edges, lengths = grid_edges(np.ones((5, 7), np.bool_))
    assert len(edges) == 5 * 6 + 4 * 7 + 2 * 4 * 6
    assert np.unique(edges, axis=0).shape == edges.shape
    places = np.stack([edges // 7, edges % 7], -1)
    np.testing.assert_allclose(np.linalg.norm(places[:, 0] - places[:, 1], axis=1), lengths)
