"""Queries about the user's own drivers."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from service.drivers.models import Driver
from service.files.models import File


def get(session: Session, name: str) -> Driver | None:
    return session.get(Driver, name)


def with_files(session: Session) -> Sequence[tuple[Driver, File]]:
    """All drivers with their files, by name."""
    query = select(Driver, File).join(File, File.id == Driver.file_id).order_by(Driver.name)
    return [(driver, file) for driver, file in session.execute(query)]


def erase(session: Session, name: str) -> None:
    session.execute(delete(Driver).where(Driver.name == name))
