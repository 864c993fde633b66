"""The estimate of how long a job still takes."""

from __future__ import annotations

import pytest

from worker.eta import Eta


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def run(*steps: tuple[float, float]) -> float | None:
    clock = Clock()
    eta, left = Eta(clock), None
    for seconds, fraction in steps:
        clock.now += seconds
        left = eta.after(fraction)
    return left


def test_even_work_is_estimated_exactly() -> None:
    assert run((0, 0.0), *((1, i / 20) for i in range(1, 11))) == pytest.approx(10, abs=0.1)


def test_a_resumed_job_does_not_count_what_an_earlier_attempt_did() -> None:
    assert run((5, 0.6), (1, 0.7), (1, 0.8)) == pytest.approx(2, abs=0.1)


def test_a_stage_that_was_stored_before_is_no_work() -> None:
    assert run((0, 0.0), (1, 0.1), (0.1, 0.5), (0.9, 0.6)) == pytest.approx(4, abs=0.1)


def test_too_little_is_no_estimate() -> None:
    assert run((0, 0.0), (0.5, 0.5)) is None
    assert run((0, 0.0), (60, 0.01)) is None
