"""The corpus through the real service: each file ends in a documented code or in a result, and nothing else happens."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from corpus import Specimen, corpus
from running import Running, eventually

ROOT = Path(__file__).parent.parent.parent
SEED = int(os.environ.get("GALATEA_HOSTILE_SEED", "7"))
MAX_GROWTH_MB = 150
"""How much the API and the worker may grow while a hundred files and more pass through."""


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    folder = tmp_path_factory.mktemp("hostile")
    running = Running(
        folder / "data",
        kinds="media_kind:KIND",
        path=Path(__file__).parent,
        concurrency=2,
        job_memory_mb=1500,
        job_cpu_seconds=120,
        image_mb=20,
        video_mb=20,
    )
    yield running
    running.stop()


def documented() -> set[str]:
    """Every code that the documentation of the API names."""
    return set(re.findall(r"`([a-z_]+)`", (ROOT / "docs" / "api.md").read_text()))


def upload(running: Running, one: Specimen) -> tuple[str | None, str | None]:
    """Send it as it is, name and all, without a library that would tidy it up: (file id, code)."""
    name = one.name.replace('"', "%22").encode("utf-8", "surrogatepass")
    declared = one.declared.encode("latin-1", "replace")
    body = (
        b'--edge\r\nContent-Disposition: form-data; name="file"; filename="' + name + b'"\r\nContent-Type: '
        + declared + b"\r\n\r\n" + one.content + b"\r\n--edge--\r\n"
    )  # fmt: skip
    headers = {"content-type": "multipart/form-data; boundary=edge"}
    response = running.client.post("/v1/files", content=body, headers=headers)
    answer: dict[str, Any] = response.json()
    assert response.status_code == 201 or 400 <= response.status_code < 500, (one.what, answer)
    if response.status_code == 201:
        assert re.fullmatch(r"[^/\\\x00-\x1f]{1,255}", answer["name"]), one.what
    return answer.get("id"), answer.get("code")


def outside(running: Running) -> dict[str, float]:
    """What lies around the data folder and in places that the corpus aims at, with the times of change."""
    around = [path for path in running.data_dir.parent.iterdir() if path not in (running.data_dir, running.output)]
    aims = [Path("/tmp/escaped"), Path("/etc"), Path("/etc/passwd"), Path("/etc/cron.d")]
    program = [path for part in ("engine", "service", "worker") for path in (ROOT / part).rglob("*.py")]
    return {str(path): path.stat().st_mtime for path in [*around, *aims, *program] if path.exists()}


def memory_mb(process: psutil.Process) -> float:
    return process.memory_info().rss / 1e6


@pytest.mark.timeout(1500)
def test_each_file_ends_in_a_result_or_a_documented_code(service: Running, tmp_path: Path) -> None:
    specimens = corpus(SEED, tmp_path)
    assert len(specimens) >= 180
    lasting = [psutil.Process(service.process.pid), *service.processes("shell.main worker")]
    eventually(lambda: len(service.processes("worker.job_process.child")) == 2, "the processes for jobs are ready")
    children = {process.pid for process in service.processes("worker.job_process.child")}
    before, weight = outside(service), [memory_mb(process) for process in lasting]

    codes: Counter[str] = Counter()
    jobs: dict[str, Specimen] = {}
    for one in specimens:
        file, code = upload(service, one)
        if file is None:
            codes[str(code)] += 1
            continue
        job = {"kind": "media", "inputs": {one.role: file}}
        response = service.client.post("/v1/jobs", json=job)
        if response.status_code == 202:
            jobs[response.json()["id"]] = one
        else:
            codes[response.json()["code"]] += 1
    assert len(jobs) > 100
    wrong = []
    for job_id, one in jobs.items():
        ended = service.until(job_id, "succeeded", "failed", seconds=600)
        code = ended["error"]["code"] if ended["error"] else "succeeded"
        codes[code] += 1
        if code in ("internal_error", "not_permitted", "attempts_exhausted"):
            wrong.append((one.what, ended["error"]))
    print(dict(codes.most_common()))
    assert not wrong
    assert codes.keys() - {"succeeded"} <= documented()
    assert codes["succeeded"] > 25, "the honest ones are among them"

    assert all(process.is_running() for process in lasting), "the API and the worker are the same as before"
    assert {process.pid for process in service.processes("worker.job_process.child")} == children, (
        "so are those that fork for jobs"
    )
    assert outside(service) == before
    for process, weighed in zip(lasting, weight, strict=True):
        assert memory_mb(process) < weighed + MAX_GROWTH_MB
    assert not list((service.data_dir / "incoming").iterdir())
    eventually(lambda: not list((service.data_dir / "jobs").glob("*/attempt-*")), "no attempt left anything")
