"""Colours told apart: mixtures against densities that are known, cuts against all labellings and against what was drawn."""

from __future__ import annotations

from itertools import product

import cv2
import numpy as np
import pytest
from scipy.stats import multivariate_normal

from engine.geometry.graph_cut import energy
from engine.imaging.masks.colour_segmentation import (
    MIN_MIXTURE_PIXELS,
    MIN_VARIANCE,
    UNSEEDED_MARK,
    ColourMixture,
    ContrastGraph,
    colour_costs,
    grab_cut,
    log_likelihood_ratio,
    smoothed_map,
)

RED, BLUE = (200.0, 60.0, 50.0), (40.0, 80.0, 190.0)


def noisy(image: np.ndarray, sigma: float, seed: int = 0) -> np.ndarray:
    return image + np.random.default_rng(seed).normal(0, sigma, image.shape)


def two_halves(size: int, border: int, sigma: float) -> np.ndarray:
    """Red up to a column and blue from there."""
    return noisy(np.where((np.arange(size) < border)[None, :, None], RED, BLUE) * np.ones((size, size, 1)), sigma)


def test_a_mixture_has_the_density_of_its_gaussians() -> None:
    rng = np.random.default_rng(3)
    weights, means = np.array([0.25, 0.75]), rng.uniform(0, 255, (2, 3))
    factors = rng.normal(0, 9, (2, 3, 3))
    covariances = factors @ factors.transpose(0, 2, 1) + 4 * np.eye(3)
    colours = means[rng.integers(0, 2, 40)] + rng.normal(0, 12, (40, 3))
    density = sum(
        w * multivariate_normal(mean, covariance).pdf(colours)
        for w, mean, covariance in zip(weights, means, covariances, strict=True)
    )
    found = ColourMixture(weights, means, covariances).negative_log_likelihood(colours)
    np.testing.assert_allclose(found, -np.log(np.maximum(density, 1e-30)), rtol=1e-9)


def test_what_is_fitted_has_the_mean_and_the_covariance_of_the_colours() -> None:
    """Clusters part the colours, so that by the law of total covariance nothing is lost but what is added to each."""
    colours = noisy(np.array([RED, BLUE, (90.0, 200.0, 90.0)])[np.arange(900) % 3], 7.0)
    mixture = ColourMixture.fit(colours)
    assert mixture.weights.sum() == pytest.approx(1)
    mean = mixture.weights @ mixture.means
    np.testing.assert_allclose(mean, colours.mean(0), atol=1e-3)
    between = np.einsum("k,ki,kj->ij", mixture.weights, mixture.means - mean, mixture.means - mean)
    within = np.einsum("k,kij->ij", mixture.weights, mixture.covariances)
    np.testing.assert_allclose(between + within, np.cov(colours.T) + MIN_VARIANCE * np.eye(3), rtol=0.02, atol=2)


def test_one_colour_alone_has_a_mixture_in_which_it_is_the_likeliest() -> None:
    mixture = ColourMixture.fit(np.tile(RED, (MIN_MIXTURE_PIXELS, 1)))
    costs = mixture.negative_log_likelihood(np.array([RED, np.add(RED, 2), BLUE]))
    assert costs[0] == pytest.approx(1.5 * np.log(2 * np.pi * MIN_VARIANCE) - np.log(mixture.weights.sum()))
    assert costs[0] < costs[1] < costs[2]


def test_too_few_colours_say_nothing() -> None:
    with pytest.raises(ValueError, match="49 colours are too few"):
        ColourMixture.fit(np.zeros((MIN_MIXTURE_PIXELS - 1, 3)))


def test_in_another_light_what_is_a_little_off_is_likelier() -> None:
    mixture = ColourMixture.fit(noisy(np.tile(RED, (500, 1)), 2.0))
    off = np.add(RED, 10)[None]
    wide = mixture.widened(100.0)
    assert wide.negative_log_likelihood(off) < mixture.negative_log_likelihood(off)
    np.testing.assert_allclose(wide.covariances - mixture.covariances, np.tile(100 * np.eye(3), (5, 1, 1)))


def test_costs_have_a_column_for_each_mixture() -> None:
    mixtures = [ColourMixture.fit(noisy(np.tile(colour, (200, 1)), 5.0)) for colour in (RED, BLUE)]
    colours = np.array([RED, BLUE, RED])
    costs = colour_costs(mixtures, colours)
    np.testing.assert_array_equal(costs.argmin(1), [0, 1, 0])
    np.testing.assert_array_equal(costs[:, 1], mixtures[1].negative_log_likelihood(colours))


def test_a_map_keeps_the_sum_of_its_values_and_is_in_reading_order() -> None:
    area = np.zeros((40, 50), np.bool_)
    area[20, 20], area[22, 25] = True, True
    found = smoothed_map(np.array([3.0, -1.0]), area, 1.5)
    assert found.sum() == pytest.approx(2.0, abs=1e-4)
    assert np.unravel_index(found.argmax(), found.shape) == (20, 20)
    assert np.unravel_index(found.argmin(), found.shape) == (22, 25)


def test_a_ratio_says_whose_colours_they_are_and_by_no_more_than_its_limit() -> None:
    image = two_halves(60, 30, 6.0)
    area = np.ones((60, 60), np.bool_)
    area[:, 50:] = False
    red, blue = (ColourMixture.fit(image[:, columns].reshape(-1, 3)) for columns in (slice(30), slice(30, 60)))
    found = log_likelihood_ratio(image, area, red, blue, 1.0, limit=5.0)
    np.testing.assert_allclose(found[:, :26], 5, atol=0.01)
    np.testing.assert_allclose(found[:, 34:46], -5, atol=0.01)
    np.testing.assert_allclose(found[:, 54:], 0, atol=1e-6)
    np.testing.assert_allclose(log_likelihood_ratio(image, area, blue, red, 1.0, limit=5.0), -found, atol=1e-5)


def test_neighbours_of_one_colour_hold_together_most_and_those_across_an_edge_least() -> None:
    image = two_halves(12, 6, 0.0)
    graph = ContrastGraph.of(image, np.ones((12, 12), np.bool_))
    across = (graph.edges % 12 < 6).sum(1) == 1
    squares = ((image.reshape(-1, 3)[graph.edges[:, 0]] - image.reshape(-1, 3)[graph.edges[:, 1]]) ** 2).sum(1)
    assert across.sum() == 12 + 2 * 11
    assert np.unique(graph.weights[~across]).tolist() == pytest.approx([8 / np.sqrt(2), 8])
    lengths = np.where(np.isin(np.diff(graph.edges, axis=1).ravel(), (1, 12)), 1.0, np.sqrt(2))
    np.testing.assert_allclose(graph.weights, 8 * np.exp(-squares / (2 * squares.mean())) / lengths)
    assert graph.weights[across].max() < graph.weights[~across].min()


@pytest.mark.parametrize("seed", range(4))
def test_two_labels_with_seeds_are_cut_as_well_as_can_be(seed: int) -> None:
    """Against all labellings of twelve pixels that hold to the seeds."""
    rng = np.random.default_rng(seed)
    area = np.ones((3, 4), np.bool_)
    graph = ContrastGraph.of(rng.uniform(0, 255, (3, 4, 3)), area)
    costs = rng.uniform(0, 20, (12, 2))
    seeds = np.full(12, UNSEEDED_MARK)
    seeds[[1, 10]] = 0, 1
    allowed = [np.array(labels) for labels in product(range(2), repeat=12) if labels[1] == 0 and labels[10] == 1]
    best = min(energy(costs, graph.edges, graph.weights, labels) for labels in allowed)
    found = graph.cut(costs, costs.argmin(1), seeds)
    assert found[1] == 0 and found[10] == 1
    assert energy(costs, graph.edges, graph.weights, found) == pytest.approx(best, abs=1e-3)


def test_a_seed_of_another_label_has_no_say() -> None:
    """Its own label, either of them, costs the same: its neighbours decide."""
    graph = ContrastGraph.of(np.full((3, 3, 3), 80.0), np.ones((3, 3), np.bool_))
    seeds = np.full(9, UNSEEDED_MARK)
    seeds[4] = 2
    for label in (0, 1):
        costs = np.zeros((9, 2))
        costs[:, 1 - label] = 100.0
        costs[4] = costs[4, ::-1]
        np.testing.assert_array_equal(graph.cut(costs, np.full(9, 1 - label), seeds), label)


def test_a_cut_runs_where_the_colours_change_and_not_where_it_began() -> None:
    image = two_halves(60, 34, 12.0)
    area = np.ones((60, 60), np.bool_)
    red, blue = (ColourMixture.fit(image[:, columns].reshape(-1, 3)) for columns in (slice(10), slice(50, 60)))
    costs = colour_costs([red, blue], image[area])
    begun = np.tile(np.arange(60) >= 20, (60, 1)).astype(int)[area]
    found = ContrastGraph.of(image, area).cut(costs, begun).reshape(60, 60)
    np.testing.assert_array_equal(found, np.tile(np.arange(60) >= 34, (60, 1)))


def scene() -> tuple[np.ndarray, np.ndarray]:
    """A red disk before blue, and where it is."""
    rows, columns = np.mgrid[:80, :100]
    disk = np.hypot(columns - 45, rows - 40) < 22
    image = np.clip(noisy(np.where(disk[..., None], RED, BLUE), 8.0), 0, 255).astype(np.uint8)
    return image, disk


def test_grab_cut_finds_a_disk_from_a_spot_in_it_and_the_rim_of_the_picture() -> None:
    image, disk = scene()
    foreground, background = np.zeros_like(disk), np.ones_like(disk)
    foreground[38:42, 43:47], background[4:-4, 4:-4] = True, False
    found = grab_cut(image, foreground, background, ~background, rounds=3)
    assert (found & disk).sum() > 0.995 * (found | disk).sum()


def test_seeds_of_grab_cut_are_kept_whatever_their_colours() -> None:
    image, disk = scene()
    foreground, background = cv2.erode(disk.astype(np.uint8), np.ones((9, 9))) > 0, ~disk
    foreground[2:6, 2:6], background[2:6, 2:6] = True, False  # of the background's colours
    background[40, 45], foreground[40, 45] = True, False
    found = grab_cut(image, foreground, background, disk, rounds=2)
    assert found[foreground].all() and not found[background].any()


def test_grab_cut_has_the_same_answer_each_time_and_leaves_what_it_is_given() -> None:
    image, disk = scene()
    given = image.copy(), np.zeros_like(disk), ~cv2.dilate(disk.astype(np.uint8), np.ones((9, 9))).astype(np.bool_)
    first = grab_cut(*given, probable=disk, rounds=2)
    cv2.setRNGSeed(77)
    np.testing.assert_array_equal(grab_cut(*given, probable=disk, rounds=2), first)
    np.testing.assert_array_equal(given[0], image)


@pytest.mark.parametrize("everywhere", [True, False])
def test_where_all_or_nothing_may_be_foreground_that_is_the_answer(everywhere: bool) -> None:
    image, disk = scene()
    nowhere = np.zeros_like(disk)
    found = grab_cut(image, nowhere, nowhere, np.full_like(disk, everywhere), rounds=2)
    np.testing.assert_array_equal(found, everywhere)
