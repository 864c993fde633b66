"""Rows smoothed between steps."""

from __future__ import annotations

import numpy as np

from engine.imaging.filling.between_steps import smoothed_between, steps_of_all


def sides(*heights: int) -> np.ndarray:
    """Two columns (60, 2, 3), each black down to its height and white from there on."""
    rows = np.arange(60)[:, None, None]
    return np.where(rows < np.array(heights)[None, :, None], 0.0, 255.0) * np.ones(3)


KNOWN = np.ones((60, 2), np.bool_)


def test_a_step_of_all_columns_is_told_where_it_is() -> None:
    np.testing.assert_array_equal(steps_of_all(sides(25, 25), KNOWN, 5, 20), [25])


def test_a_step_of_one_column_is_none() -> None:
    assert len(steps_of_all(sides(25, 60), KNOWN, 5, 20)) == 0
    assert len(steps_of_all(sides(10, 45), KNOWN, 5, 20)) == 0


def test_of_whom_one_column_is_known_that_tells() -> None:
    known = KNOWN.copy()
    known[:, 1] = False
    np.testing.assert_array_equal(steps_of_all(sides(25, 60), known, 5, 20), [25])


def test_a_stripe_has_two_steps() -> None:
    values = sides(20, 20) - sides(30, 30)
    np.testing.assert_array_equal(steps_of_all(values, KNOWN, 4, 20), [20, 30])


def test_a_slope_has_no_step() -> None:
    values = np.linspace(0, 255, 60)[:, None, None] * np.ones((60, 2, 3))
    assert len(steps_of_all(values, KNOWN, 3, 30)) == 0


def test_nothing_is_averaged_over_a_step() -> None:
    values = sides(25, 25) + 20 * np.sin(np.arange(60))[:, None, None]
    found = smoothed_between(values, np.array([25]), 6.0)
    np.testing.assert_allclose(found[:25], 0, atol=3)
    np.testing.assert_allclose(found[25:], 255, atol=3)
    assert smoothed_between(values, np.array([], int), 6.0)[24:26].mean() < 200


def test_rows_that_a_step_mixes_do_not_count() -> None:
    values = sides(25, 25)
    values[24:26] = 127
    found = smoothed_between(values, np.array([25]), 6.0, soft=1)
    np.testing.assert_allclose(found, sides(25, 25), atol=1e-3)
