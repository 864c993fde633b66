"""A disk that becomes full: the job fails with a reason, the service lives."""

from __future__ import annotations

import resource
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path

import pytest
from galatea_command import galatea
from running import Running

from service.disk import keep_ballast, require_space
from service.problems import Problem
from service.settings import Settings


def test_a_job_that_fills_the_disk_fails_and_the_service_lives(
    small_disk: Path, start: Callable[..., Running], picture: bytes
) -> None:
    fill_by_a_job(start(small_disk / "data", disk_reserve_mb=0), picture)


def fill_by_a_job(running: Running, picture: bytes) -> None:
    job = running.until(running.submit(picture, crash="disk")["id"], "failed")
    assert job["error"]["code"] == "disk_full"
    assert list(job["artifacts"]) == ["preview.jpg"]
    assert not (running.data_dir / "jobs" / job["id"] / "attempt-1").exists(), "what it wrote is gone"
    running.until(running.submit(picture)["id"], "succeeded")


def test_what_is_still_to_come_counts_as_if_it_were_there(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, disk_reserve_mb=0)
    require_space(settings, 1000)
    with pytest.raises(Problem) as refused:
        require_space(settings, shutil.disk_usage(tmp_path).free + 10**10)
    assert (refused.value.status, refused.value.code) == (507, "disk_reserve")
    reserved = Settings(data_dir=tmp_path, disk_reserve_mb=shutil.disk_usage(tmp_path).free / 1e6 + 10_000)
    with pytest.raises(Problem):
        require_space(reserved)


def test_below_the_reserve_nothing_new_is_accepted_and_what_is_there_is_kept(
    small_disk: Path, start: Callable[..., Running], picture: bytes, video: bytes
) -> None:
    running = start(small_disk / "data", disk_reserve_mb=20)
    fill_by_a_job(running, picture)
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


def test_on_a_full_disk_a_job_can_be_erased(small_disk: Path, start: Callable[..., Running], picture: bytes) -> None:
    token = galatea(small_disk / "data", "keys", "create", "root").stdout.strip()
    running = start(small_disk / "data", disk_reserve_mb=1)
    running.client.headers["Authorization"] = f"Bearer {token}"
    spare = running.data_dir / "ballast"
    job = running.until(running.submit(picture)["id"], "succeeded")
    assert spare.stat().st_size == 8_000_000
    # So that the next request has to note that the key was used.
    with closing(sqlite3.connect(running.data_dir / "galatea.db")) as database, database:
        database.execute("UPDATE keys SET last_used_at = NULL")
    with (small_disk / "filled").open("wb", buffering=0) as filled, suppress(OSError):
        while filled.write(bytes(4096)):
            pass
    assert shutil.disk_usage(small_disk).free < 4096
    assert running.client.get(f"/v1/jobs/{job['id']}").status_code == 200
    assert running.client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert running.client.get(f"/v1/jobs/{job['id']}").status_code == 404
    assert not spare.exists(), "given up"
    (small_disk / "filled").unlink()
    assert running.client.post("/v1/files", files={"file": picture}).status_code == 201
    assert spare.stat().st_size == 8_000_000, "and made again when there is room"
    running.stop()


def test_a_spare_file_that_found_no_room_is_made_again(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path)
    bounds = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, bounds[1]))
    try:
        keep_ballast(settings)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, bounds)
    assert list(tmp_path.iterdir()) == []
    keep_ballast(settings)
    assert (tmp_path / "ballast").stat().st_size == 8_000_000
