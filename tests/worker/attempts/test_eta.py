"""The estimate of how long a job still takes."""

from __future__ import annotations

import pytest

from worker.attempts.eta import Eta


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def run(*steps: tuple[float, float], cold: int = 0) -> float | None:
    """What is said at the end; the first `cold` steps are the first stage of a process that has not done this before."""
    clock = Clock()
    eta, left = Eta(cold > 0, clock), None
    for number, (seconds, fraction) in enumerate(steps):
        clock.now += seconds
        left = eta.after(fraction, "first" if number < cold else "second")
        assert left is None or number >= cold
    return left


def test_even_work_is_estimated_exactly() -> None:
    assert run((0, 0.0), *((1, i / 20) for i in range(1, 11))) == pytest.approx(10, abs=0.1)


def test_a_resumed_job_does_not_count_what_an_earlier_attempt_did() -> None:
    assert run((5, 0.6), (1, 0.7), (1, 0.8)) == pytest.approx(2, abs=0.1)


def test_a_stage_that_was_stored_before_is_no_work() -> None:
    assert run((0, 0.0), (1, 0.1), (0.1, 0.5), (0.9, 0.6)) == pytest.approx(4, abs=0.1)


def test_a_slow_beginning_is_forgotten_once_as_much_again_is_done() -> None:
    assert run((0, 0.0), (30, 0.02), (1, 0.04), (1, 0.06)) == pytest.approx(47, abs=1)


def test_the_first_stage_of_a_process_that_never_did_this_says_nothing() -> None:
    assert run((0, 0.0), (40, 0.1), (40, 0.2), cold=3) is None
    assert run((0, 0.0), (40, 0.1), (40, 0.2), (1, 0.3), (1, 0.4), (1, 0.5), cold=3) == pytest.approx(5, abs=0.1)


def test_too_little_is_no_estimate() -> None:
    assert run((0, 0.0), (0.5, 0.5)) is None
    assert run((0, 0.0), (60, 0.01)) is None
