"""A disk that becomes full: the job fails with a reason, the service lives."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from running import Running


@pytest.mark.parametrize("reserve", [0, 20])
def test_a_job_that_fills_the_disk_fails_and_the_service_lives(
    small_disk: Path, start: Callable[..., Running], picture: bytes, reserve: int
) -> None:
    running = start(small_disk / "data", disk_reserve_mb=reserve)
    job = running.until(running.submit(picture, crash="disk")["id"], "failed")
    assert job["error"]["code"] == "disk_full"
    assert list(job["artifacts"]) == ["preview.jpg"]
    assert not (running.data_dir / "jobs" / job["id"] / "attempt-1").exists(), "what it wrote is gone"
    running.until(running.submit(picture)["id"], "succeeded")
    running.stop()


def test_below_the_reserve_nothing_new_is_accepted_and_what_is_there_is_kept(
    small_disk: Path, start: Callable[..., Running], picture: bytes, video: bytes
) -> None:
    running = start(small_disk / "data", disk_reserve_mb=20)
    job = running.until(running.submit(picture)["id"], "succeeded")
    file = job["inputs"]["image"]
    ballast = small_disk / "ballast"
    ballast.write_bytes(bytes(45_000_000))
    for response in (
        running.client.post("/v1/files", files={"file": picture}),
        running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": file}}),
        running.client.post("/v1/drivers", data={"name": "new"}, files={"file": video}),
    ):
        assert (response.status_code, response.json()["code"]) == (507, "disk_reserve")
    assert running.client.get("/readyz").status_code == 503
    assert running.client.get(job["artifacts"]["animation.mp4"]["url"]).status_code == 200
    ballast.unlink()
    assert running.client.post("/v1/files", files={"file": picture}).status_code == 201
    running.stop()
