"""What spreads within a mask."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.grid_diffusion import diffuse


def test_on_open_ground_it_is_a_blur_of_known_width() -> None:
    mask = np.ones((81, 81), np.bool_)
    drop = np.zeros((81, 81), np.float32)
    drop[40, 40] = 1
    spread = diffuse(drop.reshape(-1, 1), mask, 24).reshape(81, 81).astype(float)
    assert abs(spread.sum() - 1) < 1e-4
    at = np.arange(81) - 40
    assert abs((spread.sum(0) * at**2).sum() - 24 * 2 / 3) < 0.01
    np.testing.assert_allclose(spread, spread.T, atol=1e-7)


def test_it_never_crosses_a_gap() -> None:
    mask = np.ones((20, 21), np.bool_)
    mask[:, 10] = False
    values = np.zeros((20, 21), np.float32)
    values[:, :10] = 1
    spread = np.zeros((20, 21), np.float32)
    spread[mask] = diffuse(values[mask][:, None], mask, 500)[:, 0]
    np.testing.assert_allclose(spread[:, :10], 1, atol=1e-5)
    assert not spread[:, 11:].any()


def test_what_is_even_stays_and_shares_go_on_summing_to_one() -> None:
    rng = np.random.default_rng(3)
    mask = rng.random((30, 40)) > 0.3
    shares = rng.dirichlet(np.ones(5), int(mask.sum())).astype(np.float32)
    np.testing.assert_allclose(diffuse(shares, mask, 40).sum(1), 1, atol=1e-4)
    even = np.full((int(mask.sum()), 2), 0.25, np.float32)
    np.testing.assert_allclose(diffuse(even, mask, 40), 0.25, atol=1e-5)
