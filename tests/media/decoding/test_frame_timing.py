"""Rates from timestamps, and resampling by them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.media.decoding.timing import at_own_times, exact_rate, rate_of, resample, without_echoes


@given(
    fps=st.floats(5, 120),
    count=st.integers(2, 300),
    tremble=st.floats(0, 0.3),
    seed=st.integers(0, 1000),
    origin=st.floats(-5, 1000),
)
def test_a_trembling_grid_comes_back_frame_by_frame(
    fps: float, count: int, tremble: float, seed: int, origin: float
) -> None:
    times = origin + (np.arange(count) + np.random.default_rng(seed).uniform(-tremble, tremble, count)) / fps
    rate = rate_of(times, [fps])
    assert rate.constant
    frames = resample(((time - times[0], k) for k, time in enumerate(times)), rate.fps, rate.phase, 1 / rate.fps)
    assert [k for _, k in frames] == list(range(count))


def test_the_header_is_believed_only_where_the_timestamps_agree() -> None:
    times = np.arange(1000) / 29.97
    assert rate_of(times, [30000 / 1001]).fps == 30000 / 1001
    assert rate_of(times, [25.0]).fps == pytest.approx(29.97, abs=1e-6)


def test_a_changing_rate_is_not_constant() -> None:
    times = np.concatenate([np.arange(30) / 30, 1 + np.arange(15) / 15])
    rate = rate_of(times, [22.5])
    assert not rate.constant and rate.fps == 30


@pytest.mark.parametrize("seed", range(20))
def test_a_clock_that_strays_keeps_its_usual_rate(seed: int) -> None:
    """Phones: each step is a few milliseconds off, and the errors add up."""
    steps = 1 / 30 + np.random.default_rng(seed).uniform(-0.005, 0.005, 400)
    assert rate_of(np.cumsum(steps)).fps == pytest.approx(30, rel=0.01)


def test_long_pauses_do_not_count() -> None:
    steps = np.full(100, 0.1)
    steps[[20, 60]] = 60.0
    rate = rate_of(np.cumsum(steps))
    assert not rate.constant and rate.fps == 10


def test_no_rate_is_made_up_beyond_sixty() -> None:
    rate = rate_of(np.cumsum(np.repeat([0.002, 0.5], 100)))
    assert not rate.constant and rate.fps == 60


def test_a_grid_with_a_few_holes_is_constant() -> None:
    times = np.delete(np.arange(60) / 30, [10, 40, 41])
    rate = rate_of(times, [28.5])
    assert rate_of(times, [30.0]).constant and rate_of(times, [30.0]).fps == 30
    assert not rate.constant or rate.fps == pytest.approx(30, rel=0.01)
    frames = resample(((time, time) for time in times), 30, 0.0, 1 / 30)
    assert [shown for _, shown in frames][9:12] == [times[9], times[9], times[10]]


def test_a_quicker_rate_that_would_leave_holes_is_not_believed() -> None:
    """A GIF of 30 frames a second has its times in hundredths: 3, 3 and 4 of them, and its header's guess is 33."""
    rate = rate_of(np.round(np.arange(60) / 30, 2), [100 / 3])
    assert rate.constant and rate.fps == pytest.approx(30, rel=1e-3)


def test_hidden_reference_frames_are_left_out() -> None:
    shown = np.arange(40) / 30
    packets = np.sort(np.concatenate([shown, shown[8::16] + 0.001]))
    assert np.array_equal(without_echoes(packets), shown)


def test_a_row_of_stills_gets_a_usual_rate() -> None:
    rate = rate_of(np.array([0.0, 20.0, 40.0]), [0.05])
    assert not rate.constant and rate.fps == 5


def test_a_held_frame_is_repeated_until_the_next() -> None:
    frames = list(resample([(0.0, "a"), (0.3, "b")], 10, 0.0, 0.2))
    assert [name for _, name in frames] == ["a", "a", "a", "b", "b"]
    assert [time for time, _ in frames] == pytest.approx([0, 0.1, 0.2, 0.3, 0.4])


def test_of_frames_of_one_moment_the_last_is_shown() -> None:
    frames = [(0.0, "a"), (0.1, "b"), (0.1, "c"), (0.5, "d")]
    assert list(at_own_times(frames, 0.0)) == [(0.0, "a"), (0.1, "c"), (0.5, "d")]
    assert list(at_own_times(frames, 0.3)) == [(0.3, "c"), (0.5, "d")]


def test_of_many_frames_too_short_to_be_seen_some_are_shown() -> None:
    """Each is on show for less than a frame can be; together they last for two seconds."""
    shown = list(at_own_times([(0.0005 * k, k) for k in range(4000)], 0.0))
    assert 500 < len(shown) <= 2000
    assert all(time <= 0.0005 * frame <= time + 0.001 for time, frame in shown)


def test_nothing_in_nothing_out() -> None:
    assert list(at_own_times([], 0.0)) == []
    assert list(resample([], 25, 0.0, 1.0)) == []


@pytest.mark.parametrize(
    ("fps", "fraction"),
    [
        (30, Fraction(30)),
        (29.97, Fraction(30000, 1001)),
        (30000 / 1001, Fraction(30000, 1001)),
        (23.976, Fraction(24000, 1001)),
        (59.94, Fraction(60000, 1001)),
        (12.5, Fraction(25, 2)),
        (1, Fraction(1)),
    ],
)
def test_exact_rates(fps: float, fraction: Fraction) -> None:
    assert exact_rate(fps) == fraction
