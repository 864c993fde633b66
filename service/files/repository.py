"""Queries about files."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from service.drivers.models import Driver
from service.files.models import File
from service.jobs.models import JobFile


def get(session: Session, file_id: str) -> File | None:
    return session.get(File, file_id)


def erase_unused(session: Session, ids: Sequence[str] | None = None, before: datetime | None = None) -> list[str]:
    """Erase those of these files (or of all files made before a moment) that no job and no driver uses.

    Returns the storage keys that are free once the session has been committed.
    """
    used = exists().where(JobFile.file_id == File.id) | exists().where(Driver.file_id == File.id)
    query = select(File).where(~used)
    if ids is not None:
        query = query.where(File.id.in_(ids))
    if before is not None:
        query = query.where(File.created_at < before)
    files = session.scalars(query).all()
    session.execute(delete(File).where(File.id.in_([file.id for file in files])))
    return [file.key for file in files]


def known(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are files."""
    return set(session.scalars(select(File.id).where(File.id.in_(ids))))
