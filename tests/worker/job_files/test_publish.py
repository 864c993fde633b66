"""Publishing: whole or not at all, under the lease, and never what a link points at."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from service.clock import now
from service.context import Context
from service.figures import counters
from service.ids import new_id
from service.job_records import artifacts
from service.jobs import leases
from service.jobs.leases import Lease
from service.tables.jobs import Job
from worker.job_files.plain_files import FileRefused
from worker.job_files.publish import publish, publish_all


@pytest.fixture
def lease(context: Context) -> Lease:
    job = Job(
        id=new_id(),
        owner="local",
        **{"kind": "tiny", "status": "queued", "inputs": {}, "sources": {}, "options": {}, "notes": {}},
        **{"progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with context.database.write() as session:
        session.add(job)
    with context.database.write() as session:
        lease = leases.claim(session, job.id, "me", 30)
    assert lease is not None
    return lease


@pytest.fixture
def out(tmp_path: Path) -> Path:
    folder = tmp_path / "out"
    folder.mkdir()
    return folder


def shown(context: Context, lease: Lease) -> dict[str, bytes]:
    with context.database.read() as session:
        found = artifacts.of_jobs(session, [lease.job_id])[lease.job_id]
    contents = {artifact.name: context.storage.local(artifact.key).read_bytes() for artifact in found}
    assert [a.sha256 for a in found] == [hashlib.sha256(contents[a.name]).hexdigest() for a in found]
    return contents


def stored(context: Context) -> int:
    return len(list(context.storage.local("artifacts").glob("*"))) if context.storage.local("artifacts").exists() else 0


def test_a_newer_one_of_the_same_name_replaces_the_older(context: Context, lease: Lease, out: Path) -> None:
    (out / "preview.jpg").write_bytes(b"first")
    marks = {"preview.jpg": publish(context, lease, out / "preview.jpg")}
    (out / "preview.jpg").write_bytes(b"second")
    (out / "report.json").write_bytes(b"{}")
    assert publish_all(context, lease, out, {n: m for n, m in marks.items() if m})
    assert shown(context, lease) == {"preview.jpg": b"second", "report.json": b"{}"}
    assert stored(context) == 2


def test_what_is_published_already_is_not_stored_again(context: Context, lease: Lease, out: Path) -> None:
    (out / "preview.jpg").write_bytes(b"first")
    mark = publish(context, lease, out / "preview.jpg")
    assert mark is not None
    (before,) = context.storage.local("artifacts").iterdir()
    assert publish_all(context, lease, out, {"preview.jpg": mark})
    assert list(context.storage.local("artifacts").iterdir()) == [before]


def test_without_the_lease_nothing_is_published_and_nothing_left(context: Context, lease: Lease, out: Path) -> None:
    (out / "report.json").write_bytes(b"{}")
    with context.database.write() as session:
        assert leases.cancel(session, lease.job_id)
    assert publish(context, lease, out / "report.json") is None
    assert not publish_all(context, lease, out, {})
    assert shown(context, lease) == {}
    assert stored(context) == 0


def test_only_seconds_that_can_be_believed_are_counted(context: Context, lease: Lease, out: Path) -> None:
    """A job's process may be in a stranger's hands: what it says of its stages must not spoil the figures for good."""
    stages = '{"read": 1.5, "draw": 0, "before": -3, "ever": 1e9, "never": NaN, "endless": Infinity}'
    (out / "report.json").write_text(f'{{"stages": {stages}}}')
    assert publish_all(context, lease, out, {})
    with context.database.read() as session:
        counted = list(counters.all_counters(session))
    assert {labels[1]: value for name, labels, value in counted if name == "galatea_stage_seconds"} == {
        "read": 1.5,
        "draw": 0.0,
    }


@pytest.mark.parametrize("report", ["", "[]", "{}", '{"stages": 3}', '{"stages": {"a": "b"}}', "[" * 100_000])
def test_a_report_that_says_nothing_ends_no_job(context: Context, lease: Lease, out: Path, report: str) -> None:
    (out / "report.json").write_text(report)
    assert publish_all(context, lease, out, {})


@pytest.mark.parametrize("what", ["link", "folder", "pipe", "name"])
def test_what_is_no_plain_file_under_a_plain_name_is_refused(
    context: Context, lease: Lease, out: Path, what: str
) -> None:
    (out / "a.json").write_bytes(b"{}")
    path = out / ("b\n<.json" if what == "name" else "b.json")
    match what:
        case "link":
            path.symlink_to("/etc/hostname")
        case "folder":
            path.mkdir()
        case "pipe":
            os.mkfifo(path)
        case "name":
            path.write_bytes(b"{}")
    with pytest.raises(FileRefused):
        publish_all(context, lease, out, {})
    assert shown(context, lease) == {}
    assert stored(context) == 0
