"""Nothing is lost: processes are killed at bad moments, and every accepted job ends as it should, once."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator

import psutil
import pytest
import redis
from running import Running, eventually

from service.redis_server import socket_path


@pytest.fixture(scope="module")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that mends what is done to it: all that a test kills is there again. Two jobs run at once."""
    data = tmp_path_factory.mktemp("mending") / "data"
    with Running(data, lease_seconds=3, sweep_seconds=0.5, concurrency=2) as running:
        yield running


def attempts(running: Running, job_id: str) -> int:
    with running.client.stream("GET", f"/v1/jobs/{job_id}/events") as events:
        return events.read().decode().count('{"status": "running"}')


def job_processes(running: Running) -> list[psutil.Process]:
    """The processes of the jobs that run: those that the ready ones have forked."""
    processes = running.processes("worker.job_process.child")
    ready = {process.pid for process in processes}
    return [process for process in processes if process.ppid() in ready]


def test_a_worker_killed_in_mid_job_finishes_it_later_once(running: Running, picture: bytes) -> None:
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


def test_a_jobs_process_killed_in_mid_job_is_replaced_at_once(running: Running, picture: bytes) -> None:
    """Of two jobs side by side, one's own process, and of the other the one that it was forked from."""
    (worker,) = running.processes("shell.main worker")
    expired = running.output.read_text().count("lease_expired")
    jobs = [running.rest(picture, rest_once=True) for _ in range(2)]
    one, other = job_processes(running)
    one.kill()
    psutil.Process(other.ppid()).kill()
    for job in jobs:
        running.until(job, "succeeded")
        assert attempts(running, job) == 2
    assert worker.is_running() and running.output.read_text().count("lease_expired") == expired


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
    running: Running, picture: bytes, number: signal.Signals
) -> None:
    """Streams that are open do not hold it up."""
    jobs = [running.rest(picture, rest_once=True) for _ in range(2)]
    jobs.append(running.submit(picture)["id"])
    processes = psutil.Process(running.process.pid).children(recursive=True)
    assert len(processes) >= 3
    with running.client.stream("GET", f"/v1/jobs/{jobs[0]}/events") as events:
        assert next(events.iter_lines())
        running.process.send_signal(number)
        running.process.wait(90)
    _, alive = psutil.wait_procs(processes, timeout=90)
    assert alive == []
    running.client.close()
    running.start()
    for job in jobs:
        running.until(job, "succeeded")


def test_two_services_do_not_share_a_folder(running: Running) -> None:
    command = [sys.executable, "-m", "shell.main", "serve", "--port", "0"]
    done = subprocess.run(command, env=running.environment, cwd=running.cwd, capture_output=True, text=True)
    assert done.returncode == 2 and "Another `galatea serve` uses" in done.stderr
    assert running.client.get("/readyz").status_code == 200
