"""Queries about uploads. Every change is guarded, so that one that was erased or went on meanwhile stays as it is."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, delete, select, update
from sqlalchemy.orm import Session

from service.tables.uploads import Upload


def get(session: Session, owner: str, upload_id: str) -> Upload | None:
    upload = session.get(Upload, upload_id)
    return upload if upload is not None and upload.owner == owner else None


def advance(session: Session, upload: Upload, **values: Any) -> bool:
    """Change an upload that is still as `upload` says. Returns whether it was."""
    unchanged = (Upload.id == upload.id, Upload.received == upload.received, Upload.file_id.is_(None))
    changed = session.execute(update(Upload).where(*unchanged).values(**values))
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def erase(session: Session, upload_id: str) -> None:
    session.execute(delete(Upload).where(Upload.id == upload_id))


def erase_expired(session: Session, before: datetime) -> list[str]:
    """Erase the unfinished uploads that expired before a moment. Returns their ids."""
    return _erase(session, Upload.expires_at < before)


def existing_ids(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are uploads that are not finished."""
    return set(session.scalars(select(Upload.id).where(Upload.id.in_(ids), Upload.file_id.is_(None))))


def erase_all(session: Session, owner: str) -> list[str]:
    """Erase all unfinished uploads of an owner. Returns their ids."""
    return _erase(session, Upload.owner == owner)


def _erase(session: Session, which: ColumnElement[bool]) -> list[str]:
    """In one statement, so that none that goes on at this moment is erased by what it was a moment before."""
    return list(session.scalars(delete(Upload).where(which, Upload.file_id.is_(None)).returning(Upload.id)))
