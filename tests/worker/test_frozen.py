"""What is frozen has not ended, and is missed all the same: by its silence."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator

import psutil
import pytest
from running import Running, eventually

from tests.worker.test_killed import attempts, job_processes


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that misses its programs before long. Two jobs run at once."""
    data = tmp_path_factory.mktemp("watchful") / "data"
    with Running(data, lease_seconds=3, sweep_seconds=0.5, silent_seconds=8, concurrency=2) as running:
        yield running


def said(running: Running, what: str) -> int:
    """How often the service has said this."""
    return running.output.read_text().count(what)


def checks(running: Running) -> dict[str, bool]:
    return running.client.get("/readyz").json()["checks"]


def test_a_frozen_worker_is_missed_said_and_replaced_and_its_job_done(running: Running, picture: bytes) -> None:
    before = said(running, "program_frozen")
    eventually(lambda: checks(running)["worker"], "it lives")
    job = running.rest(picture, rest_once=True)
    (worker,) = running.processes("shell.main worker")
    worker.suspend()
    eventually(lambda: not checks(running)["worker"], "it is missed")
    eventually(lambda: not worker.is_running(), "it is ended")
    eventually(lambda: checks(running)["worker"], "another one lives")
    assert running.until(job, "succeeded", "failed")["status"] == "succeeded"
    assert attempts(running, job) == 2
    assert said(running, "program_frozen") > before


def test_a_frozen_process_of_a_job_is_replaced(running: Running, picture: bytes) -> None:
    """Of two jobs side by side, one's own process, and of the other the one that it was forked from."""
    missed = "was stopped and did not go on"
    before = said(running, missed)
    jobs = [running.rest(picture, rest_once=True) for _ in range(2)]
    one, other = job_processes(running)
    one.suspend()
    psutil.Process(other.ppid()).suspend()
    eventually(lambda: said(running, missed) == before + 2, "both are missed")
    for job in jobs:
        assert running.until(job, "succeeded", "failed")["status"] == "succeeded"
        assert attempts(running, job) == 2


def test_a_frozen_redis_is_missed_and_replaced_and_holds_nobody_up(running: Running, picture: bytes) -> None:
    silent, answers = said(running, "redis_silent"), said(running, "redis_answers")
    (server,) = running.processes("redis-server")
    server.suspend()
    jobs = [running.submit(picture)["id"]]
    eventually(lambda: said(running, "redis_silent") > silent, "it is known")
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
    assert said(running, "redis_answers") > answers


def test_a_frozen_redis_holds_nobody_up_whose_requests_are_counted(start: Callable[..., Running]) -> None:
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


def test_a_service_that_was_frozen_itself_misses_nobody(running: Running) -> None:
    before = said(running, "program_frozen")
    worker = next(one for one in running.processes("shell.main worker") if one.ppid() == running.process.pid)
    both = [running.process, worker]
    for one in both:
        one.send_signal(signal.SIGSTOP)
    time.sleep(10)  # longer than either may be silent: it is the silence itself that is tested
    for one in both:
        one.send_signal(signal.SIGCONT)
    eventually(lambda: running.client.get("/readyz").status_code == 200, "all is well")
    time.sleep(2)  # in which it would have been ended
    assert worker.is_running() and said(running, "program_frozen") == before
