"""The stages of a job in the order of its pipeline."""

from __future__ import annotations

from worker.attempts.stage_order import Stages


def told(stages: Stages, *names: str) -> list[str]:
    for name in names:
        stages.begin(name)
    return stages.names


def test_they_come_in_the_order_in_which_they_begin_each_once() -> None:
    assert told(Stages(), "a", "a", "b", "a", "c") == ["a", "b", "c"]


def test_what_an_earlier_attempt_was_not_told_of_takes_its_place() -> None:
    assert told(Stages(["fetch", "a", "d"]), "a", "b", "c", "d", "e") == ["fetch", "a", "b", "c", "d", "e"]


def test_news_is_told_once() -> None:
    stages = Stages(["a"])
    told(stages, "a")
    assert not stages.news()
    told(stages, "b")
    assert (stages.news(), stages.news()) == (True, False)


def test_a_job_that_names_stages_without_end_is_cut_short() -> None:
    assert len(told(Stages(), *map(str, range(1000)))) == 100
