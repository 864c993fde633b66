"""The one-euro filter: quiet at rest, quick in motion."""

from __future__ import annotations

import numpy as np

from engine.perception.one_euro import OneEuroFilter

SPAN = 1 / 30


def followed(points: np.ndarray, beta: float = 10.0) -> np.ndarray:
    """(N, V, D) points at 30 frames a second, steadied."""
    steady = OneEuroFilter(1.5, beta, 6.0)
    return np.stack([steady(one, k * SPAN) for k, one in enumerate(points)])


def test_what_does_not_move_stays_where_it_is() -> None:
    points = np.repeat(np.random.default_rng(1).normal(size=(1, 5, 3)), 20, axis=0)
    np.testing.assert_allclose(followed(points), points, atol=1e-12)


def test_jitter_at_rest_is_less_than_half_of_what_it_was() -> None:
    noise = np.random.default_rng(2).normal(0, 0.002, (300, 8, 2))
    steady = followed(noise)
    assert np.diff(steady[30:], axis=0).std() < 0.5 * np.diff(noise[30:], axis=0).std()


def test_a_fast_step_is_there_within_three_frames() -> None:
    """A lid that shuts: 0.2 of a unit within a frame."""
    step = np.zeros((20, 1, 1))
    step[10:] = 0.2
    steady = followed(step)[:, 0, 0]
    assert abs(steady[9]) < 1e-9 and steady[12] > 0.95 * 0.2


def test_without_speed_it_is_the_low_pass_of_its_cutoff() -> None:
    """With beta 0: a step answers as 1 - (1 - a)^n, a = 2 pi f T / (2 pi f T + 1)."""
    step = np.ones((10, 1, 1))
    step[0] = 0
    rate = 2 * np.pi * 1.5 * SPAN
    expected = 1 - (1 - rate / (rate + 1)) ** np.arange(10)
    np.testing.assert_allclose(followed(step, beta=0.0)[:, 0, 0], expected, atol=1e-12)


def test_a_moment_that_is_not_later_changes_nothing() -> None:
    steady = OneEuroFilter(1.5, 10.0, 6.0)
    first = steady(np.zeros((2, 2)), 1.0)
    np.testing.assert_array_equal(steady(np.ones((2, 2)), 1.0), first)
