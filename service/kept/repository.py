"""Queries about what users keep; `shelf` says where."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from service.kept.shelves import Shelf
from service.tables.files import File
from service.tables.kept import Kept


def get(session: Session, shelf: Shelf, owner: str, name: str) -> Kept | None:
    return session.get(shelf.table, (owner, name))


def with_files(session: Session, shelf: Shelf, owner: str) -> Sequence[tuple[Kept, File]]:
    """All that an owner keeps there with the files, by name."""
    table = shelf.table
    query = select(table, File).join(File, File.id == table.file_id)
    query = query.where(table.owner == owner).order_by(table.name)
    return [(kept, file) for kept, file in session.execute(query)]


def set_look_job(session: Session, shelf: Shelf, owner: str, name: str, job_id: str) -> bool:
    """Note which job looks into a kept file. Returns whether there is the file."""
    table = shelf.table
    changed = session.execute(
        update(table).where(table.owner == owner, table.name == name).values({table.look_job: job_id})
    )
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def rename(session: Session, shelf: Shelf, owner: str, name: str, new: str) -> bool:
    """Give something another name. Returns whether it is there; raises IntegrityError where that name is taken."""
    table = shelf.table
    changed = session.execute(update(table).where(table.owner == owner, table.name == name).values({table.name: new}))
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def erase(session: Session, shelf: Shelf, owner: str, name: str) -> None:
    session.execute(delete(shelf.table).where(shelf.table.owner == owner, shelf.table.name == name))


def erase_all(session: Session, shelf: Shelf, owner: str) -> None:
    session.execute(delete(shelf.table).where(shelf.table.owner == owner))
