"""Total variation denoising, by answers that are known."""

from __future__ import annotations

import numpy as np
import pytest

from engine.imaging.total_variation import denoised

ALMOST_NONE = 1e-3
"""Of Huber's width: as good as the absolute value."""


def test_a_constant_stays() -> None:
    field = np.full((20, 30), 3.25)
    np.testing.assert_allclose(denoised(field, 1.0, 0.05), field, atol=1e-5)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_step_keeps_its_place_and_loses_the_weight_over_its_plateaus_widths(axis: int) -> None:
    field = np.zeros((8, 30))
    field[:, 10:] = 5
    expected = np.where(np.arange(30) < 10, 2.0 / 10, 5 - 2.0 / 20)  # each plateau moves by weight / width
    found = denoised(field if axis else field.T, 2.0, ALMOST_NONE)
    np.testing.assert_allclose(found if axis else found.T, np.tile(expected, (8, 1)), atol=0.03)


def test_a_slope_below_hubers_width_is_smoothed_as_by_a_membrane() -> None:
    field = np.zeros((1, 41))
    field[0, 20] = 0.02
    found = denoised(field, 1.0, 1.0)
    laplacian = np.zeros((41, 41))
    for k in range(40):
        laplacian[[k, k + 1], [k, k + 1]] += 1
        laplacian[k, k + 1] -= 1
        laplacian[k + 1, k] -= 1
    np.testing.assert_allclose(found[0], np.linalg.solve(np.eye(41) + laplacian, field[0]), atol=1e-5)


def test_noise_goes_and_the_edge_stays() -> None:
    random = np.random.default_rng(0)
    truth = np.where(np.hypot(*np.mgrid[-30:30, -40:40]) < 20, 1.6, 1.0)
    found = denoised(truth + random.normal(0, 0.2, truth.shape), 0.4, 0.01)
    assert np.abs(found - truth).mean() < 0.035
    assert found[30, 40] - found[30, 5] > 0.45


def test_what_is_not_trusted_is_filled_from_around() -> None:
    field = np.ones((30, 30))
    field[10:20, 10:20] = 9
    trust = np.ones((30, 30))
    trust[10:20, 10:20] = 0
    found = denoised(field, 1.0, 0.05, trust)
    assert np.abs(found - 1).max() < 0.25
