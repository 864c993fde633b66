"""Avatars as jobs: two clips uploaded, the work done behind walls, and canceled in its midst."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from running import Running, eventually

from engine.avatar.sample import SAMPLE_FRAMES, sample_clip

OPTIONS = {
    **{f"{name}_frames": count for name, count in SAMPLE_FRAMES.items()},
    **{"height_m": 1.8, "texture_size": 1024, "size": [96, 160], "fps": 5, "seconds": 1},
}


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("avatars") / "data"
    with Running(folder, kinds="engine.kinds:KINDS", worker_kinds="avatar") as running:
        yield running


def ordered(service: Running) -> str:
    clips = {name: (f"{name}.mp4", sample_clip(name).read_bytes(), "video/mp4") for name in ("body", "head")}
    order = {"kind": "avatar", "options": json.dumps(OPTIONS)}
    return str(service.client.post("/v1/jobs", data=order, files=clips).raise_for_status().json()["id"])


def until_at(service: Running, job: str, stage: str) -> None:
    eventually(lambda: service.job(job)["progress"]["stage"] == stage, f"the job is at {stage}", seconds=900)
    assert service.job(job)["status"] == "running"


def test_an_avatar_at_work_is_over_once_it_is_canceled(service: Running) -> None:
    job = ordered(service)
    until_at(service, job, "find_cameras")
    assert service.client.post(f"/v1/jobs/{job}/cancel").raise_for_status().json()["status"] == "canceled"
    eventually(lambda: not list((service.data_dir / "jobs" / job).glob("attempt-*")), "the attempt is over", 60)
    assert (service.job(job)["status"], service.job(job)["error"]) == ("canceled", None)
