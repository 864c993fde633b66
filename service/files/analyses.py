"""Analyses of files that serve many jobs: where they lie, and that they go when the file does.

An analysis holds much of what its file shows. So it belongs to the same owner, and does not outlive the last file
of this owner with the same content.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.context import Context
from service.settings import Settings
from service.tables.files import File

LIBRARY_OWNER = "library"
"""Stands where an owner would, for the built-in libraries."""


def folder(settings: Settings, owner: str, content: str) -> Path:
    """Where the analysis of a content is kept for an owner; `content` is a file's SHA-256, or a library item's name."""
    return settings.data_dir / "cache" / owner / content


def erase_unneeded(context: Context, contents: Iterable[tuple[str, str]]) -> None:
    """Erase the analyses of these pairs of owner and SHA-256 that no file needs any more."""
    for owner, content in contents:
        with context.database.read() as session:
            needed = owner == LIBRARY_OWNER or _holds(session, owner, content)
        if not needed:
            shutil.rmtree(folder(context.settings, owner, content), ignore_errors=True)


def stored_analyses(settings: Settings) -> list[tuple[str, str]]:
    """The pairs of owner and content whose analyses lie on this machine."""
    return [(one.parent.name, one.name) for one in (settings.data_dir / "cache").glob("*/*")]


def _holds(session: Session, owner: str, sha256: str) -> bool:
    query = select(File.id).where(File.owner == owner, File.sha256 == sha256).limit(1)
    return session.scalar(query) is not None
