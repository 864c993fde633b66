"""A real portrait is canceled in the midst of its work: it is over soon, and the next one is made."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from running import Running, eventually

SOON = 10.0
"""Seconds: what a machine takes that is busy with other tests, where an idle one takes two; the work would take longer."""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    running = Running(
        tmp_path_factory.mktemp("portraits") / "data", kinds="engine.kinds:KINDS", worker_kinds="portrait"
    )
    yield running
    running.stop()


@pytest.fixture(scope="module")
def inputs(service: Running, media: Callable[[str], Path]) -> dict[str, str]:
    """A photograph, and a video of somebody who opens his mouth."""
    named = {"image": "portraits/photo_woman_white.png", "driver": "driving/man_mouth_open_d18.mp4"}
    sent = {part: media(name) for part, name in named.items()}
    answers = {part: service.client.post("/v1/files", files={"file": path.open("rb")}) for part, path in sent.items()}
    return {part: answer.raise_for_status().json()["id"] for part, answer in answers.items()}


def ordered(service: Running, inputs: dict[str, str], **options: Any) -> str:
    asked = {"kind": "portrait", "inputs": inputs, "options": options}
    return service.client.post("/v1/jobs", json=asked).raise_for_status().json()["id"]


def test_a_portrait_at_work_is_over_once_it_is_canceled(service: Running, inputs: dict[str, str]) -> None:
    canceled = [canceled_at(service, inputs, "track_driver", 8.0)]
    # It has a part of the video to itself: of what the other has tracked, the worker would pass the stage by.
    canceled.append(canceled_at(service, inputs, "animate", 7.5))
    done = service.until(ordered(service, inputs, trim=[0, 0.3], size=[480, 480]), "succeeded", "failed", seconds=300)
    assert done["error"] is None and "animation.mp4" in done["artifacts"]
    for job in map(service.job, canceled):
        assert (job["status"], job["error"]) == ("canceled", None)
        assert "animation.mp4" not in job["artifacts"]
        assert done["started_at"] > job["finished_at"], "one worker does one after the other"


def canceled_at(service: Running, inputs: dict[str, str], stage: str, end: float) -> str:
    """A portrait of the video's first seconds that was canceled at a stage, and is over soon; its id."""
    job = ordered(service, inputs, trim=[0, end], size=[480, 480])
    folder = service.data_dir / "jobs" / job
    eventually(lambda: service.job(job)["progress"]["stage"] == stage, f"the job is at {stage}", seconds=300)
    assert service.job(job)["status"] == "running" and list(folder.glob("attempt-*"))
    assert service.client.post(f"/v1/jobs/{job}/cancel").raise_for_status().json()["status"] == "canceled"
    eventually(lambda: not list(folder.glob("attempt-*")), "the attempt is over", SOON)
    return job
