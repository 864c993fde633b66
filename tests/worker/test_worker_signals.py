"""A worker on its own tells by its exit status what ended it."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from celery import signals
from running import Running, eventually

import worker.app  # noqa: F401 - it makes Celery's signals such that they may interrupt one another


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
        started = subprocess.Popen(
            [sys.executable, "-m", "shell.main", "worker"],
            env=alone.environment, stdout=output, stderr=output, cwd=tmp_path,
        )  # fmt: skip
    try:
        eventually(lambda: alone.job(job)["status"] == "succeeded", "it works")
        started.send_signal(number)
        assert started.wait(300) == status, log.read_text()
    finally:
        started.kill()
        started.wait()
    said = log.read_text()
    assert "Traceback" not in said
    assert (said.splitlines()[-1] == "Stopped.") is (number == signal.SIGINT)


def test_a_signal_may_interrupt_another_that_is_being_told_of() -> None:
    """Celery tells of its end under a lock, in a handler that a second signal interrupts."""
    told: list[str] = []

    def hear(sig: str = "", **_: object) -> None:
        told.append(sig)

    def interrupted() -> None:
        with signals.worker_shutting_down.lock:
            signals.worker_shutting_down.send(sender=None, sig="SIGTERM", how="Warm", exitcode=0)

    signals.worker_shutting_down.connect(hear, weak=False)
    handler = threading.Thread(target=interrupted, daemon=True)
    handler.start()
    handler.join(30)
    assert told == ["SIGTERM"]
    signals.worker_shutting_down.disconnect(hear)


def test_a_worker_that_is_told_many_times_ends(alone: Running, picture: bytes, tmp_path: Path) -> None:
    job = alone.submit(picture)["id"]
    with (tmp_path / "worker.log").open("wb") as output:
        started = subprocess.Popen(
            [sys.executable, "-m", "shell.main", "worker"],
            env=alone.environment, stdout=output, stderr=output, cwd=tmp_path,
        )  # fmt: skip
    try:
        eventually(lambda: alone.job(job)["status"] == "succeeded", "it works")
        for _ in range(20):
            if started.poll() is None:
                started.send_signal(signal.SIGTERM)
        started.wait(60)
    finally:
        started.kill()
        started.wait()
