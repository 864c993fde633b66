"""What a job's process cannot do, tried by one that does its worst; the service lives on."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from running import HERE, Running, eventually

from service.redis_server import socket_path


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    data = tmp_path_factory.mktemp("confined") / "data"
    with Running(
        data, kinds="hostile_kind:KIND", job_memory_mb=700, job_cpu_seconds=4, sweep_seconds=0.5, lease_seconds=5
    ) as running:
        eventually(lambda: bool(running.processes("shell.main worker")), "the worker starts")
        yield running


def ended(running: Running, act: str, **options: Any) -> dict[str, Any]:
    job = {"kind": "hostile", "inputs": {}, "options": {"act": act, **options}}
    job_id = running.client.post("/v1/jobs", json=job).raise_for_status().json()["id"]
    return running.until(job_id, "succeeded", "failed", seconds=300)


def tried(running: Running, act: str, **options: Any) -> str | None:
    """The code of a job that tried this; None if it succeeded."""
    before = {process.pid for process in running.processes("shell.main")}
    job = ended(running, act, **options)
    assert {process.pid for process in running.processes("shell.main")} == before, "the worker lives"
    assert running.client.get("/readyz").status_code == 200
    return job["error"]["code"] if job["error"] else None


def test_honest_work_is_let_do_its_work(service: Running) -> None:
    assert tried(service, "behave") is None


def test_there_is_no_network(service: Running) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        assert tried(service, "connect", process=server.getsockname()[1]) == "not_permitted"
    assert tried(service, "connect_unix", path=str(socket_path(service.data_dir))) == "not_permitted"
    assert tried(service, "old_interface") == "not_permitted"


def test_other_files_are_out_of_reach(service: Running, tmp_path: Path) -> None:
    ended(service, "behave")
    others = [path for path in (service.data_dir / "storage" / "artifacts").rglob("*") if path.is_file()]
    for path in ("/etc/passwd", str(service.data_dir / "galatea.db"), str(others[0]), "/proc/1/cmdline"):
        assert tried(service, "read", path=path) == "not_permitted"
    for path in (str(service.data_dir / "jobs"), str(service.data_dir / "storage"), "/tmp", "/root"):
        assert tried(service, "look", path=path) == "not_permitted"
    outside = tmp_path / "outside"
    for path in (outside, service.data_dir / "outside", HERE / "outside", Path("/dev/shm/outside")):
        assert tried(service, "write", path=str(path)) == "not_permitted"
        assert not path.exists()
    assert tried(service, "open_up", path=str(service.data_dir / "galatea.db")) == "not_permitted"
    assert tried(service, "link", path=str(service.data_dir / "galatea.db")) == "not_permitted"


def test_other_processes_are_out_of_reach(service: Running) -> None:
    (worker,) = service.processes("shell.main worker")
    assert tried(service, "end", process=worker.pid) == "not_permitted"
    assert tried(service, "end", process=-1) == "not_permitted"
    assert tried(service, "end_group") == "not_permitted"
    assert tried(service, "escape_group") == "not_permitted"
    assert tried(service, "spy", process=worker.pid) == "not_permitted"
    assert tried(service, "trace", process=worker.pid) == "not_permitted"


def test_it_can_start_no_further_ones(service: Running) -> None:
    before = len(psutil.pids())
    assert tried(service, "fork") == "not_permitted"
    assert tried(service, "execute") == "not_permitted"
    assert len(psutil.pids()) < before + 30


@pytest.mark.parametrize("act", ["spin", "spin_deafly"])
def test_computing_ends_with_its_limit(service: Running, act: str) -> None:
    assert tried(service, act) == "time_limit"


def test_memory_ends_with_its_limit(service: Running) -> None:
    assert tried(service, "eat") == "out_of_memory"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")
def test_root_works_as_nobody(service: Running) -> None:
    told = ended(service, "who")["artifacts"]["who.json"]["url"]
    nobody = [65534, 65534, 65534]
    assert service.client.get(told).raise_for_status().json() == {"user": nobody, "group": nobody, "more": []}
