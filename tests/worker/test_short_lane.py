"""Jobs that take seconds do not wait behind those that take minutes, and are held to what their kind needs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from made_motion import bvh
from running import Running, eventually

KINDS = "tiny_kind:KIND,tiny_kind:SHORT,tiny_kind:BRIEF"


@pytest.fixture(scope="module")
def busy(tmp_path_factory: pytest.TempPathFactory, picture: bytes) -> Iterator[tuple[Running, dict[str, Any]]]:
    """A service whose only slot has a job that lasts, and that job."""
    data = tmp_path_factory.mktemp("busy") / "data"
    with Running(data, kinds=f"{KINDS},engine.motion_file:KIND", lease_seconds=5, sweep_seconds=0.5) as running:
        yield running, running.job(running.rest(picture))


def submit(running: Running, kind: str, like: dict[str, Any], **options: Any) -> str:
    asked = {"kind": kind, "inputs": like["inputs"], "options": options}
    return str(running.client.post("/v1/jobs", json=asked).raise_for_status().json()["id"])


def test_a_motion_is_looked_at_while_a_long_job_has_the_only_slot(busy: tuple[Running, dict[str, Any]]) -> None:
    running, long = busy
    files = {"motion": ("walk.bvh", bvh())}
    check = running.client.post("/v1/jobs", data={"kind": "motion"}, files=files).raise_for_status().json()["id"]
    assert "motion.json" in running.until(check, "succeeded", "failed")["artifacts"]
    another = submit(running, "tiny", long)
    short = submit(running, "short", long)
    running.until(short, "succeeded")
    assert [running.job(one)["status"] for one in (long["id"], another)] == ["running", "queued"]


def test_a_kind_has_limits_of_its_own(busy: tuple[Running, dict[str, Any]]) -> None:
    running, long = busy
    offered = {kind["name"]: kind for kind in running.client.get("/v1/kinds").json()["items"]}
    assert (offered["short"]["short"], offered["tiny"]["short"]) == (True, False)
    assert offered["short"]["limits"] == {"seconds": 600, "memory_mb": 1500, "cores": 1}
    assert offered["tiny"]["limits"] == {"seconds": 3600, "memory_mb": 6000, "cores": None}

    done = running.until(submit(running, "short", long), "succeeded", "failed")
    assert running.client.get(done["artifacts"]["report.json"]["url"]).json()["inputs"].get("cores", 1) == 1
    assert running.until(submit(running, "short", long, crash="memory"), "failed")["error"]["code"] == "out_of_memory"
    error = running.until(submit(running, "brief", long, seconds=3000), "failed")["error"]
    assert error["code"] == "time_limit" and "4 seconds" in error["detail"] and "“brief”" in error["detail"]


def test_a_worker_that_stops_gives_its_short_job_back_too(start: Callable[..., Running], picture: bytes) -> None:
    running = start(kinds=KINDS, lease_seconds=900)
    long = running.job(running.rest(picture))
    short = submit(running, "short", long, seconds=500, rest_once=True)
    running.until_at_rest(short)
    (worker,) = running.processes("shell.main worker")
    worker.terminate()  # and another one is started
    eventually(lambda: not worker.is_running(), "it ends")
    assert running.until(short, "succeeded", "failed")["status"] == "succeeded"
    with running.client.stream("GET", f"/v1/jobs/{short}/events") as events:
        told = events.read().decode()
    assert told.count('{"status": "running"}') == 2 and "the worker was told to stop" in told


def test_without_a_lane_it_waits_for_its_turn(start: Callable[..., Running], picture: bytes) -> None:
    """Behind a job that does not end by itself, nor looks whether it shall: until that has had its time."""
    running = start(kinds=KINDS, short_concurrency=0, job_seconds=6)
    long = running.submit(picture, seconds=3000, polls=False)
    running.until(long["id"], "running", "failed")
    short = submit(running, "short", long)
    ended, began = running.until(long["id"], "failed"), running.until(short, "succeeded")["started_at"]
    assert ended["error"]["code"] == "time_limit"
    assert began >= ended["finished_at"]
    assert len(running.processes("worker.job_process.child")) == 1
