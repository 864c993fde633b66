"""Holes in maps, filled by what is harmonic."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.harmonic_fill import harmonic_fill


def test_a_plane_is_harmonic_and_comes_back() -> None:
    y, x = np.mgrid[:40, :50].astype(np.float32)
    plane = np.stack([2 * x - y, 0.5 * y + 3], -1)
    known = np.ones((40, 50), np.bool_)
    known[10:25, 12:40] = False
    holed = np.where(known[..., None], plane, 0).astype(np.float32)
    found = harmonic_fill(known, ~known)(holed)
    np.testing.assert_allclose(found, plane, atol=1e-3)


def test_shares_stay_between_those_around_and_sum_to_one() -> None:
    random = np.random.default_rng(3)
    known = np.ones((60, 60), np.bool_)
    known[:, 22:] = False  # open to the border of the map
    shares = random.dirichlet(np.ones(5), (60, 60)).astype(np.float32)
    wanted = np.zeros_like(known)
    wanted[20:40, 22:30] = True
    found = harmonic_fill(known, wanted)(np.where(known[..., None], shares, 0).astype(np.float32))
    np.testing.assert_allclose(found[wanted].sum(-1), 1, atol=1e-5)
    assert found.min() >= -1e-6 and found.max() <= shares.max() + 1e-6
    np.testing.assert_array_equal(found[known], shares[known])


def test_between_two_walls_values_go_over_evenly() -> None:
    known = np.zeros((9, 21), np.bool_)
    known[:, 0] = known[:, 20] = True
    walls = np.zeros((9, 21, 1), np.float32)
    walls[:, 20] = 1
    found = harmonic_fill(known, np.ones_like(known))(walls)
    np.testing.assert_allclose(found[4, :, 0], np.linspace(0, 1, 21), atol=1e-5)


def test_nothing_wanted_or_nothing_known_changes_nothing() -> None:
    values, some = np.ones((8, 8, 2), np.float32), np.eye(8, dtype=np.bool_)
    for known, wanted in ((some, some), (np.zeros_like(some), some)):
        np.testing.assert_array_equal(harmonic_fill(known, wanted)(values), values)
