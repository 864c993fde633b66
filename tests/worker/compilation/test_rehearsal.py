"""A worker that has the engine compiled first: who waits is told, nothing is taken for lost, and it happens once."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from running import Running, eventually

from worker.compilation.announcement import PREPARING_MESSAGE, PREPARING_STAGE

Start = Callable[..., Running]
TOLD = {"stage": PREPARING_STAGE, "fraction": 0.0, "message": PREPARING_MESSAGE, "eta_seconds": None}
SHOWN = TOLD | {"stages": []}
TAKEN_BACK = {"stage": None, "fraction": 0.0, "message": "", "eta_seconds": None}


@pytest.fixture
def rehearsed_when(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file with which the rehearsal ends, where nothing was compiled yet."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "compiled"))
    monkeypatch.setenv("REHEARSED_WHEN", str(tmp_path / "now"))
    return tmp_path / "now"


def said(running: Running, what: str) -> bool:
    return what in running.output.read_text()


def test_who_waits_is_told_until_it_is_over_and_it_is_not_done_again(
    start: Start, tmp_path: Path, picture: bytes, rehearsed_when: Path
) -> None:
    running = start(kinds="rehearsing_kind:KIND")
    job_id = running.submit(picture)["id"]
    eventually(lambda: running.job(job_id)["progress"]["stage"] == PREPARING_STAGE, "it is told")
    assert running.job(job_id)["status"] == "queued" and running.job(job_id)["progress"] == SHOWN
    eventually(lambda: running.processes("worker.compilation.rehearsal") != [], "it is at it")
    figures = running.client.get("/metrics").text
    assert re.search(r'galatea_queue_messages\{kind="tiny"\} 1\.0', figures), "as many messages as jobs: none is lost"
    rehearsed_when.touch()
    running.until(job_id, "succeeded")
    with running.client.stream("GET", f"/v1/jobs/{job_id}/events") as events:
        told = [json.loads(line.removeprefix("data: ")) for line in events.iter_lines() if line.startswith("data: ")]
    assert told[:4] == [{"status": "queued"}, TOLD, TAKEN_BACK, {"status": "running"}]
    assert said(running, "rehearsal_ended") and not said(running, "messages_lost")
    another = start(data_dir=tmp_path / "another", kinds="rehearsing_kind:KIND")
    eventually(lambda: another.processes("worker.job_process.child") != [], "it is ready")
    assert not said(another, "rehearsal_began")


def test_kinds_that_are_ready_do_not_wait_for_those_that_are_not(
    start: Start, tmp_path: Path, picture: bytes, rehearsed_when: Path
) -> None:
    running = start(kinds="tiny_kind:KIND,rehearsing_kind:OTHER")
    waits = running.submit(picture, kind="other")["id"]
    eventually(lambda: running.job(waits)["progress"]["stage"] == PREPARING_STAGE, "it is told")
    running.until(running.submit(picture)["id"], "succeeded")
    assert running.job(waits)["status"] == "queued"
    before = running.processes("worker.job_process.child")
    rehearsed_when.touch()
    running.until(waits, "succeeded")
    assert not any(child.is_running() for child in before), "others have loaded what was compiled"
    assert not said(running, "messages_lost")


def test_what_jobs_wait_for_does_not_give_way_and_ends_when_the_worker_is_told_to(
    start: Start, rehearsed_when: Path
) -> None:
    """It does not give way to what else the machine has to do, as jobs do."""
    running = start(kinds="rehearsing_kind:KIND")
    eventually(lambda: running.processes("worker.compilation.rehearsal") != [], "it rehearses")
    (worker,) = running.processes("shell.main worker")
    (rehearsal,) = running.processes("worker.compilation.rehearsal")
    ranked = f"/proc/{rehearsal.pid}/autogroup"
    assert rehearsal.nice() == worker.nice()
    assert not Path(ranked).exists() or Path(ranked).read_text().endswith(" nice 0\n")
    running.stop()
    assert not worker.is_running() and not rehearsal.is_running()
    assert not said(running, "program_killed")
