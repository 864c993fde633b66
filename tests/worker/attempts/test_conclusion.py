"""How an attempt ends is written as it was, and nothing stays of a job that is no more."""

from __future__ import annotations

from errno import ENOSPC
from pathlib import Path
from typing import Any

import pytest

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.job_records import jobs
from service.jobs import leases
from service.jobs.leases import Lease
from service.storage.files import StorageUnavailable
from service.tables.jobs import Job
from worker.attempts.conclusion import DISK_FULL, MAX_FOUND_CHARACTERS, conclude, erase_unneeded, unwritten_verdict
from worker.attempts.preparation import Folders

NOTHING_PUBLISHED: dict[str, tuple[int, int]] = {}


def recorded(context: Context, tree: str | None = None) -> Job:
    """A job that waits."""
    job = Job(
        id=(own := new_id()),
        owner="local",
        **{"kind": "tiny", "status": "queued", "tree": tree or own, "inputs": {}, "sources": {}, "options": {}},
        **{"notes": {}, "progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with context.database.write() as session:
        session.add(job)
    return job


def begun(context: Context) -> tuple[Job, Lease, Folders]:
    """A job that runs, and the folders of its attempt, with something in them."""
    job = recorded(context)
    with context.database.write() as session:
        lease = leases.claim(session, job.id, "me", 30)
    assert lease is not None
    folders = Folders.of(context, job, lease)
    for folder in (folders.out, folders.stages):
        folder.mkdir(parents=True)
        (folder / "found").write_bytes(b"something")
    return job, lease, folders


def reread(context: Context, job: Job) -> Job:
    with context.database.read() as session:
        return session.get_one(Job, job.id)


def end(context: Context, verdict: dict[str, Any]) -> tuple[Job, Folders, dict[str, Any]]:
    job, lease, folders = begun(context)
    came_true = conclude(context, job, lease, verdict, folders, NOTHING_PUBLISHED)
    return reread(context, job), folders, came_true


def failed_with(found: dict[str, Any]) -> dict[str, Any]:
    return {"outcome": "failed", "code": "no_face", "detail": "No face.", "correctable": ["crop"], "found": found}


def test_a_failure_says_what_it_found_and_its_attempt_is_erased(context: Context) -> None:
    job, folders, verdict = end(context, failed_with({"faces": [[1, 2, 3, 4]]}))
    assert job.status == "failed" and verdict["outcome"] == "failed"
    said = {"code": "no_face", "detail": "No face.", "correctable": ["crop"], "found": {"faces": [[1, 2, 3, 4]]}}
    assert job.error == said
    assert not folders.attempt.exists() and folders.stages.exists(), "what stages found serves a revision"


def test_more_than_may_be_found_is_not_written(context: Context) -> None:
    job, _, _ = end(context, failed_with({"faces": "x" * MAX_FOUND_CHARACTERS}))
    assert job.error is not None
    assert (job.error["code"], job.error["found"]) == ("no_face", {})


@pytest.mark.parametrize(("outcome", "fruitless"), [("stopped", 0), ("crashed", 1)])
def test_a_job_that_is_given_back_waits_again_and_a_crash_counts(
    context: Context, outcome: str, fruitless: int
) -> None:
    job, _, _ = end(context, {"outcome": outcome, "reason": "the machine was switched off"})
    assert (job.status, job.fruitless_attempts, job.lease_owner) == ("queued", fruitless, None)


def test_nothing_is_written_about_a_job_that_another_worker_has(context: Context) -> None:
    job, lease, folders = begun(context)
    with context.database.write() as session:
        assert leases.give_back(session, lease, "silent")
        other = leases.claim(session, job.id, "another", 30)
    assert other is not None
    conclude(context, job, lease, failed_with({}), folders, NOTHING_PUBLISHED)
    now_there = reread(context, job)
    assert (now_there.status, now_there.lease_owner, now_there.error) == ("running", "another", None)


def test_a_storage_that_is_away_ends_no_job_and_a_full_disk_does() -> None:
    assert unwritten_verdict(StorageUnavailable("no answer"))["outcome"] == "stopped"
    full = unwritten_verdict(OSError(ENOSPC, "No space left on device"))
    assert full == {"outcome": "failed", "code": "disk_full", "detail": DISK_FULL}
    assert unwritten_verdict(OSError(5, "I/O error"))["code"] == "internal_error"


def folder_with_something(context: Context, job_id: str) -> Path:
    folder = context.settings.job_folder(job_id)
    (folder / "stages").mkdir(parents=True)
    (folder / "stages" / "found").write_bytes(b"somebody's face")
    return folder


def test_what_is_left_of_a_deleted_job_goes_and_the_tree_s_stays_for_its_other_versions(context: Context) -> None:
    first = recorded(context)
    revision = recorded(context, first.id)
    folders = [folder_with_something(context, one.id) for one in (first, revision)]
    erase_unneeded(context, revision)
    assert [folder.exists() for folder in folders] == [True, True], "both are there"
    with context.database.write() as session:
        session.delete(session.get_one(Job, revision.id))
    erase_unneeded(context, revision)
    assert [folder.exists() for folder in folders] == [True, False]
    with context.database.write() as session:
        session.delete(session.get_one(Job, first.id))
        assert jobs.with_folder(session, [first.id]) == set()
    erase_unneeded(context, first)
    assert not any(folder.exists() for folder in folders)


def test_what_a_deleted_job_s_stages_found_stays_as_long_as_a_version_of_it_is_there(context: Context) -> None:
    first = recorded(context)
    revision = recorded(context, first.id)
    folders = [folder_with_something(context, one.id) for one in (first, revision)]
    with context.database.write() as session:
        session.delete(session.get_one(Job, first.id))
    erase_unneeded(context, first)
    assert [folder.exists() for folder in folders] == [True, True], "the revision lives on what the first one found"
    with context.database.write() as session:
        session.delete(session.get_one(Job, revision.id))
    erase_unneeded(context, revision)
    assert not any(folder.exists() for folder in folders)
