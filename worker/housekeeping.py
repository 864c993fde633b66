"""What nobody needs any more is erased: uploads that no job used, what killed processes left, old analyses."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from itertools import islice
from pathlib import Path

from sqlalchemy.orm import Session

from engine.store import StageStore
from service.artifacts import repository as artifacts
from service.clock import now
from service.context import Context
from service.files import repository as files
from service.jobs import repository as jobs
from service.settings import MEGABYTE

IN_PROGRESS = timedelta(hours=1)
"""Younger things may belong to something that is going on: a file is stored before its record is."""

IDEMPOTENCY_KEPT = timedelta(hours=24)
BATCH = 500


def keep_house(context: Context) -> None:
    """Erase once what has had its time."""
    erase_old_files(context)
    erase_orphans(context)
    StageStore(context.settings.data_dir / "cache").trim(context.settings.cache_mb * MEGABYTE)


def erase_old_files(context: Context) -> None:
    """Erase files that were uploaded long ago and that no job and no driver uses; forget old idempotency keys."""
    with context.database.write() as session:
        keys = files.erase_unused(session, before=now() - timedelta(hours=context.settings.file_hours))
        jobs.forget_idempotency_keys(session, IDEMPOTENCY_KEPT)
    context.storage.delete(keys)


def erase_orphans(context: Context) -> None:
    """Erase what lies on disk without a record: a process was killed between storing and recording, or between
    erasing the one and the other."""
    before = now() - IN_PROGRESS
    for prefix, known in (("files", files.known), ("artifacts", artifacts.known)):
        keys = context.storage.keys(prefix, before)
        while batch := list(islice(keys, BATCH)):
            orphans = set(_without_record(context, [key.rpartition("/")[2] for key in batch], known))
            context.storage.delete(key for key in batch if key.rpartition("/")[2] in orphans)
    data = context.settings.data_dir
    folders = {folder.name: folder for folder in _older(data / "jobs", before)}
    for job_id in _without_record(context, list(folders), jobs.known):
        shutil.rmtree(folders[job_id], ignore_errors=True)
    for path in _older(data / "incoming", before):
        path.unlink(missing_ok=True)


def _without_record(
    context: Context, ids: Sequence[str], known: Callable[[Session, Sequence[str]], set[str]]
) -> list[str]:
    with context.database.read() as session:
        there = known(session, ids)
    return [one for one in ids if one not in there]


def _older(folder: Path, before: datetime) -> list[Path]:
    if not folder.is_dir():
        return []
    return [path for path in folder.iterdir() if path.stat().st_mtime < before.timestamp()]
