"""Phi and equation 1."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed

from engine.face_animation.alignment import Similarity, align, fit_similarity
from engine.face_animation.control_points import carry_fiducials
from engine.perception.landmarks import EYES_AND_NOSE_TIP


@pytest.mark.parametrize("seed", range(4))
def test_a_known_similarity_is_recovered(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle, scale, shift = rng.uniform(-3, 3), rng.uniform(0.2, 5), rng.uniform(-100, 100, 2)
    linear = scale * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    points = rng.uniform(0, 200, (12, 2))
    found = fit_similarity(points, points @ linear.T + shift)
    np.testing.assert_allclose(found.linear, linear, atol=1e-9)
    np.testing.assert_allclose(found.shift, shift, atol=1e-7)
    assert found.scale == pytest.approx(scale)


def test_it_is_the_least_squares_one() -> None:
    """No similarity near it does better on points that no similarity maps exactly."""
    rng = np.random.default_rng(0)
    a, b = rng.uniform(0, 100, (20, 2)), rng.uniform(0, 100, (20, 2))
    found = fit_similarity(a, b)
    least = ((found(a) - b) ** 2).sum()
    for _ in range(50):
        d = rng.normal(0, 0.01, 4)
        linear = found.linear + np.array([[d[0], -d[1]], [d[1], d[0]]])
        assert ((Similarity(linear, found.shift + 10 * d[2:])(a) - b) ** 2).sum() >= least


def test_mirrored_points_are_not_mirrored_back() -> None:
    points = np.random.default_rng(0).uniform(0, 10, (9, 2))
    assert np.linalg.det(fit_similarity(points, points * [-1, 1]).linear) >= 0


def test_offsets_feel_the_linear_part_alone() -> None:
    phi = Similarity(np.array([[0.0, -2.0], [2.0, 0.0]]), np.array([1000.0, -1000.0]))
    np.testing.assert_allclose(phi.offsets(np.array([[3.0, 1.0]])), [[-2.0, 6.0]])
    np.testing.assert_allclose(phi(np.array([[3.0, 1.0]])), [[998.0, -994.0]])


def test_inverse_and_matrix() -> None:
    phi = fit_similarity(np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[5.0, 5], [5, 8], [2, 5]]))
    points = np.random.default_rng(0).normal(size=(7, 2))
    np.testing.assert_allclose(phi.inverse()(phi(points)), points, atol=1e-12)
    np.testing.assert_allclose(points @ phi.matrix()[:, :2].T + phi.matrix()[:, 2], phi(points))


def test_phi_looks_at_eyes_and_nose_tip_alone() -> None:
    """Whatever the other points of the two faces do, phi is theirs."""
    driver, target = placed(40, (100, 90)), placed(80, (300, 240), roll=12)
    phi = align(driver, target)
    assert phi.scale == pytest.approx(2, abs=1e-5)
    assert np.rad2deg(np.arctan2(phi.linear[1, 0], phi.linear[0, 0])) == pytest.approx(12, abs=1e-3)
    others = np.setdiff1d(np.arange(478), EYES_AND_NOSE_TIP)
    target[others] += np.random.default_rng(0).normal(0, 30, (len(others), 3))
    np.testing.assert_allclose(align(driver, target).linear, phi.linear)


def test_equation_1_by_hand() -> None:
    """p_i^t = p_0^t + phi (p_i^S - p_0^S): a quarter turn with scale 2 carries (1, 0) to (0, 2)."""
    phi = Similarity(np.array([[0.0, -2.0], [2.0, 0.0]]), np.array([77.0, 88.0]))
    neutral, target = np.array([[10.0, 10.0], [20.0, 10.0]]), np.array([[100.0, 50.0], [100.0, 70.0]])
    frames = np.array([[[10.0, 10.0], [20.0, 10.0]], [[11.0, 10.0], [20.0, 13.0]]])
    expected = [[[100.0, 50.0], [100.0, 70.0]], [[100.0, 52.0], [94.0, 70.0]]]
    np.testing.assert_allclose(carry_fiducials(phi, frames, neutral, target), expected)
