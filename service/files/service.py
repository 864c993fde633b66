"""Keeping and erasing files."""

from __future__ import annotations

from collections.abc import Sequence

from service.clock import now
from service.context import Context
from service.files import repository
from service.files.intake import Received
from service.files.models import File
from service.ids import new_id


def keep(context: Context, received: Received) -> File:
    """Put a received file into the storage and record it."""
    file = File(
        id=new_id(),
        name=received.name,
        content_type=received.content_type,
        size=received.size,
        sha256=received.sha256,
        created_at=now(),
    )
    with received.path.open("rb") as content:
        context.storage.put(file.key, content)
    with context.database.write() as session:
        session.add(file)
    return file


def erase_unused(context: Context, ids: Sequence[str]) -> None:
    """Erase those of these files that nothing uses."""
    with context.database.write() as session:
        keys = repository.erase_unused(session, ids)
    context.storage.delete(keys)
