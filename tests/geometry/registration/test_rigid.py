"""Transforms that a test made are found again, outliers or not; where nothing fits exactly, nothing near fits better."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.geometry.registration.rigid import Similarity, fit_rigid, fit_robustly, fit_similarities, fit_similarity


def transform(dimensions: int, seed: int, scale: float) -> Similarity:
    random = np.random.default_rng(seed)
    if dimensions == 2:
        angle = random.uniform(-3, 3)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    else:
        turn = Rotation.random(rng=random).as_matrix()
    return Similarity(scale * turn, random.uniform(-100, 100, dimensions))


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_a_known_similarity_is_recovered(dimensions: int, seed: int) -> None:
    truth = transform(dimensions, seed, 0.2 + seed)
    points = np.random.default_rng(seed).uniform(0, 200, (12, dimensions))
    for weights in (None, np.linspace(0.1, 1, 12)):
        found = fit_similarity(points, truth(points), weights)
        np.testing.assert_allclose(found.linear, truth.linear, atol=1e-9)
        np.testing.assert_allclose(found.shift, truth.shift, atol=1e-7)
        assert found.scale == pytest.approx(0.2 + seed)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_known_rigid_motion_is_recovered_and_keeps_lengths(dimensions: int) -> None:
    truth = transform(dimensions, 5, 1.0)
    points = np.random.default_rng(5).uniform(0, 200, (12, dimensions))
    found = fit_rigid(points, truth(points))
    np.testing.assert_allclose(found.linear, truth.linear, atol=1e-9)
    np.testing.assert_allclose(found.shift, truth.shift, atol=1e-7)
    swollen = fit_rigid(points, truth(3 * points))
    assert swollen.scale == pytest.approx(1)
    np.testing.assert_allclose(swollen.rotation, truth.linear, atol=1e-9)


def test_many_destinations_are_fitted_at_once() -> None:
    truths = [transform(3, seed, 0.5 + seed) for seed in range(5)]
    source = np.random.default_rng(0).normal(0, 30, (50, 3))
    scale, rotation, shift = fit_similarities(source, np.stack([t(source) for t in truths]), np.ones(50))
    for k, truth in enumerate(truths):
        assert scale[k] == pytest.approx(truth.scale)
        np.testing.assert_allclose(rotation[k], truth.rotation, atol=1e-9)
        np.testing.assert_allclose(shift[k], truth.shift, atol=1e-7)


def test_in_the_plane_it_is_the_least_squares_one() -> None:
    """No similarity near it does better on points that no similarity maps exactly."""
    rng = np.random.default_rng(0)
    a, b = rng.uniform(0, 100, (20, 2)), rng.uniform(0, 100, (20, 2))
    found = fit_similarity(a, b)
    least = ((found(a) - b) ** 2).sum()
    for _ in range(50):
        d = rng.normal(0, 0.01, 4)
        linear = found.linear + np.array([[d[0], -d[1]], [d[1], d[0]]])
        assert ((Similarity(linear, found.shift + 10 * d[2:])(a) - b) ** 2).sum() >= least


def test_both_ways_to_fit_in_the_plane_agree() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.uniform(0, 100, (20, 2)), rng.uniform(0, 100, (20, 2))
    np.testing.assert_allclose(fit_similarity(a, b).matrix(), fit_similarity(a, b, np.ones(20)).matrix(), atol=1e-9)


def test_a_point_of_no_weight_does_not_count() -> None:
    truth, source = transform(3, 2, 1.2), np.random.default_rng(0).normal(0, 30, (20, 3))
    destination, weights = truth(source), np.ones(20)
    destination[3] += 500
    weights[3] = 0
    for fit in (fit_similarity, lambda *given: fit_rigid(given[0], given[1] / 1.2, given[2])):
        np.testing.assert_allclose(fit(source, destination, weights).rotation, truth.rotation, atol=1e-9)


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("fit", [fit_similarity, fit_rigid])
def test_rotations_are_never_reflections(dimensions: int, fit) -> None:
    source = np.random.default_rng(0).normal(0, 30, (20, dimensions))
    mirrored = source.copy()
    mirrored[:, -1] *= -1
    assert np.linalg.det(fit(source, mirrored).rotation) == pytest.approx(1)
    flat = source.copy()
    flat[:, -1] = 0
    if dimensions == 3:
        assert np.linalg.det(fit(flat, flat).rotation) == pytest.approx(1)


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize(("fit", "scale"), [(fit_similarity, 2.5), (fit_rigid, 1.0)])
def test_half_of_the_points_anywhere_do_not_pull(dimensions: int, fit, scale: float) -> None:
    """Good ones are off by a tenth of `sigma`; the plain fit is far away."""
    truth, rng = transform(dimensions, 7, scale), np.random.default_rng(7)
    source = rng.normal(0, 30, (60, dimensions))
    destination = truth(source) + rng.normal(0, 0.05, source.shape)
    destination[::2] = rng.uniform(-300, 300, (30, dimensions))
    found = fit_robustly(source, destination, 0.5, fit)
    assert np.abs(found.transform(source) - truth(source)).max() < 0.15
    assert np.abs(fit(source, destination, np.ones(60))(source) - truth(source)).max() > 20
    assert found.weights[::2].max() < 0.1 and found.weights[1::2].min() > 0.5


def test_offsets_feel_the_linear_part_alone() -> None:
    turned = Similarity(np.array([[0.0, -2.0], [2.0, 0.0]]), np.array([1000.0, -1000.0]))
    np.testing.assert_allclose(turned.offsets(np.array([[3.0, 1.0]])), [[-2.0, 6.0]])
    np.testing.assert_allclose(turned(np.array([[3.0, 1.0]])), [[998.0, -994.0]])


@pytest.mark.parametrize("dimensions", [2, 3])
def test_inverse_and_matrix(dimensions: int) -> None:
    truth, points = transform(dimensions, 1, 3.0), np.random.default_rng(0).normal(size=(7, dimensions))
    np.testing.assert_allclose(truth.inverse()(truth(points)), points, atol=1e-12)
    matrix = truth.matrix()
    np.testing.assert_allclose(points @ matrix[:, :-1].T + matrix[:, -1], truth(points))
