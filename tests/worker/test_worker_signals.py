"""A worker on its own tells by its exit status what ended it."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from running import Running, eventually


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service without a worker."""
    with Running(tmp_path_factory.mktemp("alone") / "data", worker="false") as running:
        yield running


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 0)], ids=["SIGINT", "SIGTERM"])
def test_a_worker_ends_as_it_is_told_to(
    alone: Running, picture: bytes, tmp_path: Path, number: signal.Signals, status: int
) -> None:
    log = tmp_path / "worker.log"
    job = alone.submit(picture)["id"]
    with log.open("wb") as output:
        worker = subprocess.Popen(
            [sys.executable, "-m", "shell.main", "worker"],
            env=alone.environment, stdout=output, stderr=output, cwd=tmp_path,
        )  # fmt: skip
    try:
        eventually(lambda: alone.job(job)["status"] == "succeeded", "it works")
        worker.send_signal(number)
        assert worker.wait(300) == status, log.read_text()
    finally:
        worker.kill()
        worker.wait()
    said = log.read_text()
    assert "Traceback" not in said
    assert (said.splitlines()[-1] == "Stopped.") is (number == signal.SIGINT)
