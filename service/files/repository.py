"""Queries about files."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from sqlalchemy import delete, exists, or_, select
from sqlalchemy.orm import Session

from service.tables.files import File
from service.tables.jobs import JobFile
from service.tables.kept import KEPT_TABLES


def get(session: Session, owner: str, file_id: str) -> File | None:
    file = session.get(File, file_id)
    return file if file is not None and file.owner == owner else None


def get_locked(session: Session, owner: str, file_id: str) -> File | None:
    """The owner's file, which nobody erases until this transaction ends, which makes use of it."""
    file = session.get(File, file_id, with_for_update={"read": True, "key_share": True})
    return file if file is not None and file.owner == owner else None


def erase_unused(
    session: Session, ids: Sequence[str] | None = None, before: datetime | None = None, owner: str | None = None
) -> list[File]:
    """Erase those of these files (or of all files made before a moment, or of one owner) that no job uses and
    nobody keeps under a name.

    Returns them; what they have in the storage is free once the session has been committed.
    """
    kept = [exists().where(table.file_id == File.id) for table in KEPT_TABLES]
    used = or_(exists().where(JobFile.file_id == File.id), *kept)
    query = select(File.id).where(~used).with_for_update(skip_locked=True)
    if ids is not None:
        query = query.where(File.id.in_(ids))
    if before is not None:
        query = query.where(File.created_at < before)
    if owner is not None:
        query = query.where(File.owner == owner)
    locked = session.scalars(query).all()
    # Looked at again once they are locked: a job may have taken one in between, and from now on none can.
    files = session.scalars(select(File).where(File.id.in_(locked), ~used)).all()
    session.execute(delete(File).where(File.id.in_([file.id for file in files])))
    return list(files)


def existing_ids(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are files."""
    return set(session.scalars(select(File.id).where(File.id.in_(ids))))
