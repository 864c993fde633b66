"""Two workers on PostgreSQL and one Redis, each ended and frozen in turn: every job is done once, and whole."""

from __future__ import annotations

import hashlib
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from running import Running, eventually
from servers import PostgresServer

JOBS = 4
LEASE_SECONDS = 3


class Two:
    """A service without a worker of its own, and two workers."""

    def __init__(self, folder: Path, postgres: PostgresServer):
        self._postgres, self._folder = postgres, folder
        url = postgres.new_database()
        self._database = url.rpartition("/")[2]
        settings = {"database_url": url, "worker": "false", "lease_seconds": LEASE_SECONDS, "sweep_seconds": 0.5}
        self.running = Running(folder / "data", **settings)
        self._logs = 0
        self.workers = [self.start(), self.start()]

    def start(self) -> subprocess.Popen[bytes]:
        self._logs += 1
        with (self._folder / f"worker{self._logs}.log").open("wb") as log:
            command = ["setpriv", "--pdeathsig", "KILL", sys.executable, "-m", "shell.main", "worker"]
            return subprocess.Popen(command, env=self.running.environment, stdout=log, stderr=log, cwd=self._folder)

    def owner(self, job: str) -> str:
        return str(self._postgres.run(f"SELECT lease_owner FROM jobs WHERE id = '{job}'", self._database)[0][0])

    def at_work(self, worker: subprocess.Popen[bytes]) -> str | None:
        """A job that a worker has and works on; of several, as of one that is about to end, any that is in its midst."""
        query = f"SELECT id FROM jobs WHERE status = 'running' AND lease_owner LIKE '%:{worker.pid}'"
        jobs = [str(row[0]) for row in self._postgres.run(query, self._database)]
        return next((job for job in jobs if self.running.job(job)["progress"]["stage"] == "rest"), None)

    def freeze(self, worker: subprocess.Popen[bytes], submit: Callable[[], object]) -> str:
        """Freeze a worker in the midst of a job, which is submitted where none waits; the job."""
        held: list[str] = []

        def frozen() -> bool:
            if not self._postgres.run("SELECT id FROM jobs WHERE status = 'queued'", self._database):
                submit()
            if self.at_work(worker) is not None:
                worker.send_signal(signal.SIGSTOP)
                if job := self.at_work(worker):
                    held.append(job)
                else:
                    worker.send_signal(signal.SIGCONT)  # it has ended meanwhile
            return held != []

        eventually(frozen, "it is frozen with a job")
        return held[0]

    def said(self, what: str) -> bool:
        return any(what in log.read_text() for log in self._folder.glob("worker*.log"))

    def stop(self) -> None:
        for worker in self.workers:
            worker.kill()
            worker.wait(30)
        self.running.stop()


@pytest.fixture
def two(tmp_path: Path, postgres: PostgresServer) -> Iterator[Two]:
    made = Two(tmp_path, postgres)
    yield made
    made.stop()


def test_whichever_worker_ends_or_freezes_each_job_is_done_once(two: Two, picture: bytes) -> None:
    running = two.running
    jobs = [running.submit(picture, seconds=2)["id"] for _ in range(JOBS)]

    def submit() -> None:
        jobs.append(running.submit(picture, seconds=4)["id"])

    for number in (0, 1):  # ended without a word, and replaced
        worker = two.workers[number]
        two.freeze(worker, submit)
        worker.kill()
        worker.wait(30)
        two.workers[number] = two.start()
    for number in (0, 1):  # frozen until another one has its job, then thawed
        worker, other = two.workers[number], two.workers[1 - number]
        job = two.freeze(worker, submit)
        eventually(lambda job=job, pid=worker.pid: not two.owner(job).endswith(f":{pid}"), "it has lost its job")
        assert other.poll() is None
        worker.send_signal(signal.SIGCONT)

    for job in jobs:
        done = running.until(job, "succeeded", "failed", "canceled")
        assert done["status"] == "succeeded", done["error"]
        told = running.client.get(f"/v1/jobs/{job}/events").text
        assert told.count('{"status": "succeeded"}') == 1
        assert {"report.json", "animation.mp4", "preview.jpg", "spectrum.json"} == done["artifacts"].keys()
        for artifact in done["artifacts"].values():
            content = running.client.get(artifact["url"]).raise_for_status().content
            assert (len(content), hashlib.sha256(content).hexdigest()) == (artifact["size"], artifact["sha256"])
    eventually(lambda: two.said("outcome=lost"), "who was frozen knows that it has lost its job")
    folders = running.data_dir / "jobs"
    eventually(lambda: not list(folders.glob("*/attempt-*/out/*")), "it has dropped what it had made")
