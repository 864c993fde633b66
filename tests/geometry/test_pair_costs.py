"""Expansion moves with a cost for each edge and pair of labels, against all labellings of small graphs."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.geometry.graph_cut import (
    PairCost,
    alpha_expansion,
    energy,
    expansion_moves,
    grid_edges,
    potts,
)


def table_cost(table: NDArray) -> PairCost:
    """Costs (E, L, L) looked up."""
    return lambda which, first, second: table[which, first, second]


def seam_costs(random: np.random.Generator, edges: int, labels: int) -> NDArray:
    """(E, L, L): how far two textures are apart at an edge, as seams have it: a metric for each edge, unlike at each."""
    colours = random.uniform(0, 1, (edges, labels, 3))
    return np.linalg.norm(colours[:, :, None] - colours[:, None], axis=3)


def any_costs(random: np.random.Generator, edges: int, labels: int) -> NDArray:
    """(E, L, L) that know no triangle inequality, nor that both ways cost the same."""
    table = random.uniform(0, 3, (edges, labels, labels)) ** 3
    table[:, np.arange(labels), np.arange(labels)] = 0
    return table


def least(unary: NDArray, edges: NDArray, cost: PairCost) -> float:
    count, labels = unary.shape
    return min(energy(unary, edges, cost, np.array(each)) for each in product(range(labels), repeat=count))


@pytest.mark.parametrize("costs", [seam_costs, any_costs])
@pytest.mark.parametrize("seed", range(4))
def test_two_labels_are_the_best_there_are(seed: int, costs) -> None:
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((3, 4), np.bool_))
    unary, cost = random.uniform(0, 2, (12, 2)), table_cost(costs(random, len(edges), 2))
    found = expansion_moves(unary, edges, cost, np.zeros(12, int))
    assert found.energy == pytest.approx(least(unary, edges, cost), abs=1e-4)
    assert found.energy == energy(unary, edges, cost, found.labels) and found.truncated == 0


@pytest.mark.parametrize("seed", range(6))
def test_metric_costs_are_within_their_bound_and_never_truncated(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((2, 4), np.bool_))
    table = seam_costs(random, len(edges), 3)
    unary, cost = random.uniform(0, 1, (8, 3)), table_cost(table)
    best = least(unary, edges, cost)
    apart = ~np.eye(3, dtype=bool)
    ratio = (table[:, apart].max(1) / table[:, apart].min(1)).max()
    found = expansion_moves(unary, edges, cost, np.zeros(8, int), sweeps=10)
    assert best - 1e-9 <= found.energy <= 2 * ratio * best
    assert found.energy <= 1.1 * best  # in fact
    assert found.truncated == 0


@pytest.mark.parametrize("seed", range(6))
def test_other_costs_are_truncated_and_said_so_and_the_energy_never_rises(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((2, 4), np.bool_))
    unary, cost = random.uniform(0, 4, (8, 3)), table_cost(any_costs(random, len(edges), 3))
    labels, before, truncated = random.integers(0, 3, 8), np.inf, 0
    for _ in range(6):
        step = expansion_moves(unary, edges, cost, labels, sweeps=1)
        assert step.energy <= min(before, energy(unary, edges, cost, labels))
        labels, before, truncated = step.labels, step.energy, truncated + step.truncated
    assert truncated > 0
    assert least(unary, edges, cost) - 1e-9 <= before


def test_the_potts_model_is_one_of_them() -> None:
    random = np.random.default_rng(4)
    edges, _ = grid_edges(np.ones((12, 15), np.bool_))
    unary, weights = random.uniform(0, 3, (180, 5)), random.uniform(0, 2, len(edges))
    found = expansion_moves(unary, edges, potts(weights), np.zeros(180, int))
    np.testing.assert_array_equal(found.labels, alpha_expansion(unary, edges, weights, np.zeros(180, int)))
    same = weights[:, None, None] * (1 - np.eye(5))
    np.testing.assert_array_equal(
        found.labels, expansion_moves(unary, edges, table_cost(same), np.zeros(180, int)).labels
    )


@pytest.mark.parametrize("seed", range(6))
def test_a_label_that_a_node_cannot_have_is_never_given_and_the_rest_is_the_best(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges, _ = grid_edges(np.ones((3, 3), np.bool_))
    edges = np.where(random.integers(0, 2, (len(edges), 1)) > 0, edges, edges[:, ::-1])
    unary = random.uniform(0, 1, (9, 2))
    unary[random.permutation(9)[:4], random.integers(0, 2, 4)] = np.inf
    cost = table_cost(any_costs(random, len(edges), 2) / 5)
    start = np.where(np.isfinite(unary[:, 0]), 0, 1)
    found = expansion_moves(unary, edges, cost, start)
    assert np.isfinite(found.energy)
    assert found.energy == pytest.approx(least(unary, edges, cost), abs=1e-4)
    if not np.isfinite(unary[:, 1]).all():
        with pytest.raises(ValueError, match="cannot have"):
            expansion_moves(unary, edges, cost, np.ones(9, int))


def test_equal_labels_are_never_asked_for() -> None:
    random = np.random.default_rng(2)
    edges, _ = grid_edges(np.ones((6, 6), np.bool_))
    table = seam_costs(random, len(edges), 3)

    def cost(which: NDArray, first: NDArray, second: NDArray) -> NDArray:
        assert len(which) and (first != second).all()
        return table[which, first, second]

    expansion_moves(random.uniform(0, 1, (36, 3)), edges, cost, np.zeros(36, int))
