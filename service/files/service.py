"""Keeping and erasing files."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy.orm import Session

from service.auth.quotas import require_room
from service.clock import now
from service.context import Context
from service.figures import counters
from service.files import analyses, repository
from service.files.received import Received
from service.ids import new_id
from service.problems import Problem
from service.tables.files import File


def keep(context: Context, owner: str, received: Received) -> File:
    """Put a received file into the storage and record it. Raises a 507 problem beyond the owner's quota."""
    file = File(
        id=new_id(),
        owner=owner,
        name=received.name,
        content_type=received.content_type,
        size=received.size,
        sha256=received.sha256,
        created_at=now(),
    )
    context.storage.adopt(file.key, received.path)
    try:
        with context.database.write() as session:
            require_room(session, context.settings, owner, file.size)
            record(session, file)
    except Problem:
        context.storage.delete([file.key])
        raise
    return file


def record(session: Session, file: File) -> None:
    """Record a file that lies in the storage."""
    session.add(file)
    session.flush()
    counters.add(session, "galatea_uploaded_bytes", file.content_type.split("/")[0], amount=file.size)


def forget(context: Context, erased: Sequence[File]) -> None:
    """Erase what is left of files that were erased from the database: their content, and analyses of it."""
    context.storage.delete(file.key for file in erased)
    analyses.erase_unneeded(context, {(file.owner, file.sha256) for file in erased})


def erase_unused(context: Context, ids: Sequence[str]) -> None:
    """Erase those of these files that nothing uses."""
    with context.database.write() as session:
        erased = repository.erase_unused(session, ids)
    forget(context, erased)
