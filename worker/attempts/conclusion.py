"""How an attempt at a job ends: its verdict made true in SQL.

A verdict's `outcome` is one of these:

- `succeeded`;
- `failed`, with `code` and `detail`;
- `crashed` or `stopped`, with a `reason`: the job is given back. A crash counts against it, and more so where it brings
  the same `death` as the last one;
- `lost`: the job is somebody else's, and nothing is written.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from errno import EDQUOT, ENOSPC
from typing import Any

from sqlalchemy.exc import SQLAlchemyError

from service.context import Context
from service.job_records import jobs as repository
from service.jobs import leases
from service.jobs.leases import Lease
from service.jobs.stages import erase
from service.storage.files import StorageUnavailable
from service.tables.jobs import Job, Status
from worker.attempts.heartbeat import renewing_lease
from worker.attempts.preparation import Folders
from worker.job_files.plain_files import FileRefused
from worker.job_files.publish import publish_all
from worker.retry_db import retry_db

MAX_FOUND_CHARACTERS = 20_000
"""Characters of what a failed job may say it has found."""

DISK_FULL = "The disk became full during the job: free space and submit it again."


def conclude(
    context: Context,
    job: Job,
    lease: Lease,
    verdict: dict[str, Any],
    folders: Folders,
    published: Mapping[str, tuple[int, int]],
) -> dict[str, Any]:
    """Publish what is not `published` yet, or record the failure, or give the job back. Returns the verdict as it came
    true: success may turn into failure where files are refused or cannot be stored, and anything into `lost`."""
    if verdict["outcome"] == "succeeded":
        try:
            with renewing_lease(context, lease):
                whole = publish_all(context, lease, folders.out, published)
            return verdict if whole else {"outcome": "lost"}
        except FileRefused as refused:
            verdict = {"outcome": "failed", "code": "internal_error", "detail": str(refused)}
        except OSError as error:
            verdict = unwritten_verdict(error)
        except SQLAlchemyError:
            verdict = {"outcome": "lost"}
    shutil.rmtree(folders.attempt, ignore_errors=True)  # first, so that a full disk has room for the record
    try:
        match verdict["outcome"]:
            case "failed":
                retry_db(lambda: _fail(context, lease, verdict), lease.seconds)
            case "crashed" | "stopped":
                retry_db(lambda: _give_back(context, job, lease, verdict), lease.seconds)
    except SQLAlchemyError:
        return {"outcome": "lost"}  # the lease has ended meanwhile, and the job is another worker's
    return verdict


def unwritten_verdict(error: OSError) -> dict[str, Any]:
    """The verdict on a job whose files could not be written."""
    if isinstance(error, StorageUnavailable):
        return {"outcome": "stopped", "reason": "the storage did not answer"}
    if error.errno in (ENOSPC, EDQUOT):
        return {"outcome": "failed", "code": "disk_full", "detail": DISK_FULL}
    return {"outcome": "failed", "code": "internal_error", "detail": f"The job's files cannot be written: {error}"}


def erase_unneeded(context: Context, job: Job) -> None:
    """Erase what is left of a job that was deleted while it ran."""
    both = [job.id, job.tree]
    try:
        with context.database.read() as session:
            unneeded = set(both) - repository.with_folder(session, both)
    except SQLAlchemyError:
        return  # cut off: housekeeping does it
    for one in unneeded:
        erase(context, one)


def _fail(context: Context, lease: Lease, verdict: Mapping[str, Any]) -> None:
    with context.database.write() as session:
        correctable = [str(name) for name in verdict.get("correctable", ())]
        found = verdict.get("found") or {}
        if len(json.dumps(found)) > MAX_FOUND_CHARACTERS:
            found = {}
        leases.fail(session, lease, str(verdict["code"]), str(verdict["detail"])[:2000], correctable, found)


def _give_back(context: Context, job: Job, lease: Lease, verdict: Mapping[str, Any]) -> None:
    with context.database.write() as session:
        death, crashed = verdict.get("death"), verdict["outcome"] == "crashed"
        status = leases.give_back(session, lease, verdict["reason"], crashed, death=str(death)[:32] if death else None)
    if status == Status.QUEUED:
        context.queue.send(job.id, job.kind)
