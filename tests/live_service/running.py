"""A real `galatea serve` for tests: own process, free loopback port, own data folder, embedded Redis, one worker."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Self

import httpx
import psutil
from newest_tables import lay_out_data_folder
from warm_start import WarmProcess, warm_server

HERE = Path(__file__).parent
ROOT = HERE.parent.parent


class Running:
    """A service that runs."""

    def __init__(
        self,
        data_dir: Path,
        path: Path = HERE,
        root: Path = ROOT,
        command: Sequence[str] | None = None,
        cwd: Path | None = None,
        **settings: Any,
    ):
        """`path` is where job kinds are imported from, `root` the program; `command` is started in the folder `cwd`. Without one the
        service is forked from what has imported the program, and finds its tables made."""
        self.data_dir = data_dir
        self.path = path
        self.root = root
        self.command = command
        self.cwd = cwd or data_dir.parent
        self.settings = settings
        self.output = data_dir.with_name(data_dir.name + ".log")
        if command is None and "database_url" not in settings:
            lay_out_data_folder(data_dir)
        self.start()

    def start(self) -> None:
        kept = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
        self.environment = kept | {
            "GALATEA_DATA_DIR": str(self.data_dir),
            "GALATEA_KINDS": "tiny_kind:KIND",
            "GALATEA_DISK_RESERVE_MB": "1",
            "GALATEA_JOB_NICENESS": "0",  # whoever waits for a job has no less of the machine than other tests
            "PYTHONPATH": os.pathsep.join([str(self.path), str(self.root)]),
            **{f"GALATEA_{name.upper()}": str(value) for name, value in self.settings.items()},
        }
        with self.output.open("wb") as output:
            self.process = self._begin(("serve", "--port", "0"), output.fileno())
        try:
            self.client = httpx.Client(base_url=self._address(), timeout=60)
            eventually(lambda: self.client.get("/readyz").status_code == 200, "the service is ready")
        except BaseException:
            self._end()
            raise

    def _begin(self, arguments: Sequence[str], output: int) -> subprocess.Popen[bytes] | WarmProcess:
        if self.command is None:
            return WarmProcess(warm_server(), arguments, self.environment, self.cwd, output)
        return subprocess.Popen(
            [*self.command, *arguments], env=self.environment, stdout=output, stderr=output, cwd=self.cwd
        )

    def _address(self) -> str:
        for _ in range(2400):
            found = re.search(r"Galatea serves at (http://\S+)/", self.output.read_text())
            if found:
                return found[1]
            assert self.process.poll() is None, self.output.read_text()
            time.sleep(0.05)
        self.process.terminate()
        raise AssertionError(self.output.read_text())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        self.client.close()
        self._end()

    def end_jobs(self, client: httpx.Client | None = None) -> None:
        """End all jobs of this client's key that have not ended, and wait until nobody works on any."""
        client = client or self.client
        under_way = {"status": ["queued", "running"], "limit": 200}
        while jobs := client.get("/v1/jobs", params=under_way).raise_for_status().json()["items"]:
            for job in jobs:
                assert client.post(f"/v1/jobs/{job['id']}/cancel").status_code in (200, 409), "409: it has just ended"
        eventually(lambda: not list((self.data_dir / "jobs").glob("*/attempt-*")), "no job is worked on")

    def _end(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            self.process.wait(90)

    def processes(self, part: str) -> list[psutil.Process]:
        """The processes under the service whose command line contains `part`."""
        found = []
        for process in psutil.Process(self.process.pid).children(recursive=True):
            try:
                if part in " ".join(process.cmdline()) and process.status() != psutil.STATUS_ZOMBIE:
                    found.append(process)
            except psutil.NoSuchProcess:
                continue
        return found

    def submit(self, picture: bytes, kind: str = "tiny", **options: Any) -> dict[str, Any]:
        """Upload a picture and submit a tiny job with these options; the job."""
        file = self.client.post("/v1/files", files={"file": ("picture.png", picture)}).raise_for_status().json()
        job = {"kind": kind, "inputs": {"image": file["id"]}, "options": options}
        return self.client.post("/v1/jobs", json=job).raise_for_status().json()

    def rest(self, picture: bytes, **options: Any) -> str:
        """A job that is at rest, for longer than any test takes; its id."""
        job = self.submit(picture, **{"seconds": 3000, **options})
        self.until_at_rest(job["id"])
        return str(job["id"])

    def job(self, job_id: str) -> dict[str, Any]:
        return self.client.get(f"/v1/jobs/{job_id}").raise_for_status().json()

    def until(self, job_id: str, *statuses: str, seconds: float = 500) -> dict[str, Any]:
        """Wait until the job has one of these statuses; the job as it was then."""
        job: dict[str, Any] = {}

        def has_come_to_it() -> bool:
            nonlocal job
            job = self.job(job_id)
            return job["status"] in statuses

        eventually(has_come_to_it, f"the job is {statuses}", seconds)
        return job

    def until_at_rest(self, job_id: str) -> None:
        """Wait until the job is in its long stage."""
        eventually(lambda: self.job(job_id)["progress"]["stage"] == "rest", "the job rests")


def eventually(true: Callable[[], bool], what: str, seconds: float = 500) -> None:
    """Wait until it is true. Who has waited long asks less often: asking takes from what is waited for."""
    began = time.monotonic()
    while not true():
        waited = time.monotonic() - began
        assert waited < seconds, f"not within {seconds} s: {what}"
        time.sleep(min(max(0.02, waited / 10), 0.5))
