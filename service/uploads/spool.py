"""The spool: what has come of uploads that are not finished, one file each, on this machine."""

from __future__ import annotations

import os
from datetime import datetime, timedelta
from pathlib import Path
from typing import IO

from service.clock import now
from service.context import Context
from service.problems import Problem
from service.settings import Settings
from service.uploads import repository


def folder(settings: Settings) -> Path:
    return settings.data_dir / "uploads"


def path(settings: Settings, upload_id: str) -> Path:
    return folder(settings) / upload_id


def create(settings: Settings, upload_id: str) -> None:
    """Make the empty file of a new upload."""
    folder(settings).mkdir(exist_ok=True)
    path(settings, upload_id).touch(exist_ok=False)


def head(file: Path, size: int) -> bytes:
    """The first bytes."""
    with file.open("rb") as content:
        return content.read(size)


def sync(file: IO[bytes] | None) -> None:
    """Wait until what was written would outlive a power cut."""
    if file is not None:
        file.flush()
        os.fdatasync(file.fileno())


def erase(context: Context, upload_id: str) -> None:
    """Erase an upload that is not finished: its record and its bytes."""
    with context.database.write() as session:
        repository.erase(session, upload_id)
    path(context.settings, upload_id).unlink(missing_ok=True)


def expiry(settings: Settings) -> datetime:
    """When an upload of which something came just now is erased, unless more comes."""
    return now() + timedelta(hours=settings.upload_hours)


def upload_gone() -> Problem:
    """The upload was there and is no more."""
    return Problem(410, "upload_expired", "The upload has expired and was erased: begin again.")
