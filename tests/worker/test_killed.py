"""Nothing is lost: processes are killed at bad moments, and every accepted job ends as it should, once."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator

import psutil
import pytest
import redis
from running import Running, eventually

from service.redis_server import socket_path

Start = Callable[..., Running]


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that mends what is done to it: all that a test kills is there again."""
    with Running(tmp_path_factory.mktemp("mending") / "data", lease_seconds=3, sweep_seconds=0.5) as running:
        yield running


def attempts(running: Running, job_id: str) -> int:
    with running.client.stream("GET", f"/v1/jobs/{job_id}/events") as events:
        return events.read().decode().count('{"status": "running"}')


def test_a_worker_killed_in_mid_job_finishes_it_later_once(start: Start, picture: bytes) -> None:
    running = start()
    job = running.rest(picture, rest_once=True)
    (worker,) = running.processes("shell.main worker")
    children = running.processes("worker.job_process.child")
    worker.kill()
    eventually(lambda: not any(child.is_running() for child in children), "its processes went with it")
    done = running.until(job, "succeeded")
    report = running.client.get(done["artifacts"]["report.json"]["url"]).json()
    assert report["quality"]["reused"] == 1, "the stage that was stored was not done again"
    assert attempts(running, job) == 2
    with running.client.stream("GET", f"/v1/jobs/{job}/events") as events:
        assert events.read().decode().count('{"status": "succeeded"}') == 1


def test_a_jobs_process_killed_in_mid_job_is_replaced_at_once(start: Start, picture: bytes) -> None:
    running = start(lease_seconds=900)
    job = running.rest(picture, rest_once=True)
    running.processes("worker.job_process.child")[0].kill()
    running.until(job, "succeeded")  # long before its lease ends
    assert attempts(running, job) == 2


# The first attempt stores a stage and so is not in vain; those after it do not.
DEATHS = [
    ("abort", "process_died", "SIGABRT", 2),
    ("segv", "process_died", "SIGSEGV", 2),
    ("exit", "process_died", "status 3", 2),
    ("kill", "attempts_exhausted", "SIGKILL", 4),  # somebody else's doing, or for want of memory: it may pass
]


def test_a_process_that_dies_once_is_forgiven_and_again_and_again_is_not(running: Running, picture: bytes) -> None:
    once = running.submit(picture, crash="segv", crash_once=True)
    jobs = {crash: running.submit(picture, crash=crash)["id"] for crash, *_ in DEATHS}
    assert running.until(once["id"], "succeeded", "failed")["status"] == "succeeded"
    for crash, code, said, times in DEATHS:
        error = running.until(jobs[crash], "failed", "succeeded")["error"]
        assert error["code"] == code and said in error["detail"], error
        assert attempts(running, jobs[crash]) == times
    assert running.until(running.submit(picture)["id"], "succeeded")


def test_redis_killed_and_restarted_loses_nothing(running: Running, picture: bytes) -> None:
    jobs = [running.submit(picture, seconds=1)["id"] for _ in range(3)]
    (server,) = running.processes("redis-server")
    server.kill()
    jobs.append(running.submit(picture)["id"])
    for job in jobs:
        running.until(job, "succeeded", seconds=180)
        assert attempts(running, job) == 1
    eventually(lambda: running.client.get("/readyz").status_code == 200, "Redis is back")


def test_redis_emptied_loses_nothing(running: Running, picture: bytes) -> None:
    jobs = [running.submit(picture, seconds=1)["id"] for _ in range(3)]
    client = redis.Redis(unix_socket_path=str(socket_path(running.data_dir)))
    client.flushall()
    client.close()
    jobs.append(running.submit(picture)["id"])
    for job in jobs:
        running.until(job, "succeeded", seconds=180)
        assert attempts(running, job) == 1


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_the_service_ends_with_all_its_processes_and_takes_up_its_jobs_again(
    start: Start, picture: bytes, number: signal.Signals
) -> None:
    running = start()
    job = running.rest(picture, rest_once=True)
    waiting = running.submit(picture)["id"]
    processes = psutil.Process(running.process.pid).children(recursive=True)
    assert len(processes) >= 3
    running.process.send_signal(number)
    running.process.wait(90)
    _, alive = psutil.wait_procs(processes, timeout=90)
    assert alive == []
    again = start(running.data_dir)
    for one in (job, waiting):
        again.until(one, "succeeded")


def test_two_services_do_not_share_a_folder(start: Start, tmp_path_factory: pytest.TempPathFactory) -> None:
    running = start(worker="false")
    with pytest.raises(AssertionError, match="Another `galatea serve` uses"):
        Running(running.data_dir)


def test_jobs_run_side_by_side_and_none_longer_than_allowed(start: Start, picture: bytes) -> None:
    running = start(concurrency=2, job_seconds=15)
    eventually(lambda: len(running.processes("worker.job_process.child")) == 2, "both processes for jobs are there")
    jobs = [running.submit(picture, seconds=3000, polls=polls)["id"] for polls in (True, False)]
    first, second = (running.until(job, "failed", "succeeded") for job in jobs)
    assert [job["error"]["code"] for job in (first, second)] == ["time_limit"] * 2
    assert second["started_at"] < first["finished_at"]


def test_open_streams_do_not_hold_up_the_end(start: Start, picture: bytes) -> None:
    running = start(worker="false")
    job = running.submit(picture)["id"]
    with running.client.stream("GET", f"/v1/jobs/{job}/events") as events:
        assert next(events.iter_lines())
        running.process.send_signal(signal.SIGINT)
        running.process.wait(90)
