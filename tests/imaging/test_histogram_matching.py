"""Distributions in CIELAB: what is matched has the reference's, in its own order."""

from __future__ import annotations

import numpy as np

from engine.imaging.histogram_matching import from_lab, matched_in_lab, to_lab


def colours(seed: int, middle: tuple[int, int, int], spread: float, count: int = 4000) -> np.ndarray:
    return np.random.default_rng(seed).normal(middle, spread, (count, 3)).clip(0, 255).astype(np.float32)


def test_the_distribution_becomes_the_reference() -> None:
    reference = colours(1, (90, 120, 150), 8)
    found = to_lab(matched_in_lab(colours(0, (190, 150, 120), 15), reference))
    steps = np.linspace(0.1, 0.9, 9)
    np.testing.assert_allclose(np.quantile(found, steps, 0), np.quantile(to_lab(reference), steps, 0), atol=1.0)


def test_the_order_of_lightness_stays() -> None:
    own = np.repeat(np.linspace(20, 230, 50)[:, None], 3, 1)
    found = to_lab(matched_in_lab(own, colours(2, (120, 120, 120), 20)))[:, 0]
    assert (np.diff(found) > -0.2).all() and np.ptp(found) > 10


def test_one_colour_goes_to_the_middle_of_the_reference() -> None:
    reference = colours(3, (60, 90, 160), 10)
    found = matched_in_lab(np.full((5, 3), 128.0), reference)
    np.testing.assert_allclose(to_lab(found), np.tile(np.median(to_lab(reference), 0), (5, 1)), atol=0.3)


def test_without_a_reference_nothing_changes() -> None:
    own = colours(4, (120, 120, 120), 20, 10)
    np.testing.assert_array_equal(matched_in_lab(own, own[:0]), own)


def test_lab_and_back() -> None:
    own = colours(5, (120, 100, 140), 60, 500)
    np.testing.assert_allclose(from_lab(to_lab(own)), own, atol=1.0)
    np.testing.assert_allclose(to_lab(np.array([[255.0, 255, 255], [0, 0, 0]])), [[100, 0, 0], [0, 0, 0]], atol=0.02)
