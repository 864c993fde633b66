"""What is frozen has not ended, and is missed all the same: by its silence."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator

import pytest
from running import Running, eventually

from tests.worker.test_killed import attempts

Start = Callable[..., Running]


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that misses no job by the end of its lease."""
    with Running(tmp_path_factory.mktemp("patient") / "data", lease_seconds=900) as running:
        yield running


def checks(running: Running) -> dict[str, bool]:
    return running.client.get("/readyz").json()["checks"]


def test_a_frozen_worker_is_missed_said_and_replaced_and_its_job_done(start: Start, picture: bytes) -> None:
    running = start(silent_seconds=6)
    assert checks(running)["worker"] is True
    job = running.rest(picture, rest_once=True)
    (worker,) = running.processes("shell.main worker")
    worker.suspend()
    eventually(lambda: not checks(running)["worker"], "it is missed")
    eventually(lambda: not worker.is_running(), "it is ended")
    eventually(lambda: checks(running)["worker"], "another one lives")
    assert running.until(job, "succeeded", "failed")["status"] == "succeeded"
    assert attempts(running, job) == 2
    assert "program_frozen" in running.output.read_text()


@pytest.mark.parametrize("part", ["the process of the job", "the process that it was forked from"])
def test_a_frozen_process_of_a_job_is_replaced(running: Running, picture: bytes, part: str) -> None:
    missed = "was stopped and did not go on"
    before = running.output.read_text().count(missed)
    job = running.rest(picture, rest_once=True)
    processes = sorted(running.processes("worker.job_process.child"), key=lambda process: process.create_time())
    assert len(processes) == 2, "the one that is ready, and the one that it forked"
    processes[1 if part.endswith("the job") else 0].suspend()
    eventually(lambda: running.output.read_text().count(missed) > before, "it is missed")
    assert running.until(job, "succeeded", "failed")["status"] == "succeeded"
    assert attempts(running, job) == 2


def test_a_frozen_redis_is_missed_and_replaced_and_holds_nobody_up(start: Start, picture: bytes) -> None:
    running = start(silent_seconds=8)
    (server,) = running.processes("redis-server")
    server.suspend()
    jobs = [running.submit(picture)["id"]]
    eventually(lambda: "redis_silent" in running.output.read_text(), "it is known")
    began = time.monotonic()
    assert checks(running)["redis"] is False
    jobs += [running.submit(picture)["id"] for _ in range(5)]
    held_up = time.monotonic() - began
    for job in jobs:
        running.until(job, "succeeded")
        assert attempts(running, job) == 1
    eventually(lambda: running.client.get("/readyz").status_code == 200, "all is well")
    assert not server.is_running()
    # Six times the ten seconds that a message waits for Redis would be sixty: nobody waited, however slow the machine.
    assert held_up < 30
    assert "redis_answers" in running.output.read_text()


def test_a_frozen_redis_holds_nobody_up_whose_requests_are_counted(start: Start) -> None:
    running = start(worker="false", silent_seconds=600)
    token = running.client.post("/v1/keys", json={"name": "somebody"}).raise_for_status().json()["token"]
    good, wrong = ({"Authorization": f"Bearer {key}"} for key in (token, "galatea_wrong"))
    (server,) = running.processes("redis-server")
    server.suspend()
    assert running.client.get("/v1/jobs", headers=good).status_code == 200
    began = time.monotonic()
    assert [running.client.get("/v1/jobs", headers=good).status_code for _ in range(20)] == [200] * 20
    assert [running.client.get("/v1/jobs", headers=wrong).status_code for _ in range(5)] == [401] * 5
    held_up = time.monotonic() - began
    server.resume()
    assert held_up < 30, "waiting for Redis each time would take a minute, however fast the machine"
    eventually(lambda: checks(running)["redis"], "it is heard again")


def test_a_service_that_was_frozen_itself_misses_nobody(start: Start) -> None:
    running = start(silent_seconds=6)
    worker = next(one for one in running.processes("shell.main worker") if one.ppid() == running.process.pid)
    both = [running.process, worker]
    for one in both:
        one.send_signal(signal.SIGSTOP)
    time.sleep(10)  # longer than either may be silent: it is the silence itself that is tested
    for one in both:
        one.send_signal(signal.SIGCONT)
    eventually(lambda: running.client.get("/readyz").status_code == 200, "all is well")
    time.sleep(2)  # in which it would have been ended
    assert worker.is_running() and "program_frozen" not in running.output.read_text()
