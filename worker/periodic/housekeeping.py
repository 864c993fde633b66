"""What nobody needs any more is erased: files that no job used, uploads that were given up, what killed processes left,
old analyses."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from contextlib import suppress
from datetime import datetime, timedelta
from itertools import islice
from pathlib import Path

from sqlalchemy.orm import Session

from engine.store import trim
from service.clock import now
from service.context import Context
from service.files import analyses
from service.files import repository as files
from service.files.service import forget
from service.job_records import artifacts, jobs
from service.jobs.service import delete
from service.jobs.stages import STAGES_PREFIX
from service.links import repository as links
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE
from service.uploads import repository as uploads
from service.uploads import spool
from service.webhooks import repository as webhooks

MIN_ORPHAN_AGE = timedelta(hours=1)
"""Younger things may belong to something that is going on: a file is stored before its record is."""

MIN_FOLDER_AGE = timedelta(minutes=1)
"""Younger folders of jobs are left alone: their process may just be ending."""

IDEMPOTENCY_KEPT = timedelta(hours=24)
BATCH_JOBS = 500


def keep_house(context: Context) -> None:
    """Erase once what has had its time."""
    erase_old_jobs(context)
    erase_old_files(context)
    forget_old_deliveries(context)
    analyses.erase_unneeded(context, analyses.stored_analyses(context.settings))
    erase_expired_uploads(context)
    erase_orphans(context)
    trim((context.settings.data_dir / "cache").glob("*/*"), context.settings.cache_mb * BYTES_PER_MEGABYTE)
    context.database.tidy()


def erase_old_jobs(context: Context) -> None:
    """Erase jobs that ended long ago, with all that belongs to them, if the operator has set how long they are kept."""
    days = context.settings.job_days
    if not days:
        return
    with context.database.read() as session:
        old = jobs.ended_before(session, now() - timedelta(days=days), BATCH_JOBS)
    for job in old:
        with suppress(Problem):  # its owner was faster
            delete(context, job.owner, job.id)


def erase_old_files(context: Context) -> None:
    """Erase files that were uploaded long ago and that no job and no driver uses; forget old idempotency keys."""
    with context.database.write() as session:
        erased = files.erase_unused(session, before=now() - timedelta(hours=context.settings.file_hours))
        jobs.forget_idempotency_keys(session, IDEMPOTENCY_KEPT)
        links.forget_expired(session)
    forget(context, erased)


def forget_old_deliveries(context: Context) -> None:
    """Erase the record of webhooks that were written long ago, whatever became of them."""
    with context.database.write() as session:
        webhooks.forget(session, now() - timedelta(days=context.settings.webhook_days))


def erase_expired_uploads(context: Context) -> None:
    """Erase uploads of which nothing more came for long."""
    with context.database.write() as session:
        expired = uploads.erase_expired(session, now())
    for upload_id in expired:
        spool.path(context.settings, upload_id).unlink(missing_ok=True)


def erase_orphans(context: Context) -> None:
    """Erase what lies on disk without a record: a process was killed between storing and recording, or between
    erasing the one and the other."""
    before = now() - MIN_ORPHAN_AGE
    for prefix, known in (
        ("files", files.existing_ids),
        ("artifacts", artifacts.existing_ids),
        (STAGES_PREFIX, jobs.with_folder),
    ):
        keys = context.storage.keys(prefix, before)
        while batch := list(islice(keys, BATCH_JOBS)):
            ids = {key: key.split("/")[1] for key in batch}  # of a stage, the id is its tree's
            orphans = set(_without_record(context, list(set(ids.values())), known))
            context.storage.delete(key for key in batch if ids[key] in orphans)
    data = context.settings.data_dir
    # A job's record is there before its folder: a folder without one is of a job that was erased, on any machine.
    folders = {folder.name: folder for folder in _older(data / "jobs", now() - MIN_FOLDER_AGE)}
    for job_id in _without_record(context, list(folders), jobs.with_folder):
        shutil.rmtree(folders[job_id], ignore_errors=True)
    erase_broken_off(context, before)
    if context.storage.folder is None:  # there are copies in the storage; what is not at work here can be fetched again
        longest = timedelta(seconds=context.settings.job_seconds)
        for folder in _older(data / "jobs", before - longest):
            shutil.rmtree(folder, ignore_errors=True)
    spooled = {path.name: path for path in _older(spool.folder(context.settings), before)}
    for upload_id in _without_record(context, list(spooled), uploads.existing_ids):
        spooled[upload_id].unlink(missing_ok=True)
    for path in _older(data / "incoming", before):
        path.unlink(missing_ok=True)


def erase_broken_off(context: Context, before: datetime) -> None:
    """Erase what attempts left whose worker was killed, of jobs that no worker has taken up again."""
    left = [folder for folder in (context.settings.data_dir / "jobs").glob("*/*-*") if _is_older(folder, before)]
    with context.database.read() as session:
        running = jobs.running(session, [folder.parent.name for folder in left])
    for folder in left:
        if folder.parent.name not in running:
            shutil.rmtree(folder, ignore_errors=True)


def _is_older(path: Path, before: datetime) -> bool:
    try:
        return path.stat().st_mtime < before.timestamp()
    except FileNotFoundError:
        return False


def _without_record(
    context: Context, ids: Sequence[str], known: Callable[[Session, Sequence[str]], set[str]]
) -> list[str]:
    with context.database.read() as session:
        there = known(session, ids)
    return [one for one in ids if one not in there]


def _older(folder: Path, before: datetime) -> list[Path]:
    if not folder.is_dir():
        return []
    return [path for path in folder.iterdir() if _is_older(path, before)]
