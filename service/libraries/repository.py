"""Queries about what users keep in a library."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from service.libraries.library import Library
from service.tables.files import File
from service.tables.kept import Kept


def get(session: Session, library: Library, owner: str, name: str) -> Kept | None:
    return session.get(library.table, (owner, name))


def with_files(session: Session, library: Library, owner: str) -> Sequence[tuple[Kept, File]]:
    """All that an owner keeps there with the files, by name."""
    table = library.table
    query = select(table, File).join(File, File.id == table.file_id)
    query = query.where(table.owner == owner).order_by(table.name)
    return [(kept, file) for kept, file in session.execute(query)]


def set_inspection_job(session: Session, library: Library, owner: str, name: str, job_id: str) -> bool:
    """Note which job inspects a kept file. Returns whether there is the file."""
    table = library.table
    changed = session.execute(
        update(table).where(table.owner == owner, table.name == name).values({table.inspection_job: job_id})
    )
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def rename(session: Session, library: Library, owner: str, name: str, new: str) -> bool:
    """Give something another name. Returns whether it is there; raises IntegrityError where that name is taken."""
    table = library.table
    changed = session.execute(update(table).where(table.owner == owner, table.name == name).values({table.name: new}))
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def erase(session: Session, library: Library, owner: str, name: str) -> None:
    session.execute(delete(library.table).where(library.table.owner == owner, library.table.name == name))


def erase_all(session: Session, library: Library, owner: str) -> None:
    session.execute(delete(library.table).where(library.table.owner == owner))
