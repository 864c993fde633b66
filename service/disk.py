"""Free space: below a reserve nothing new is accepted, and a file is kept that is given up where even erasing has no
room (a database writes before it erases)."""

from __future__ import annotations

import os
import shutil
from contextlib import suppress
from pathlib import Path

from service.problems import disk_full
from service.settings import BYTES_PER_MEGABYTE, Settings

BALLAST_MB = 8
"""What erasing may take for a moment: the database's log, and some for those who write meanwhile."""


def free_mb(settings: Settings) -> float:
    """Free space where the data lie, in megabytes."""
    return shutil.disk_usage(settings.data_dir).free / BYTES_PER_MEGABYTE


def require_space(settings: Settings, incoming_bytes: int = 0) -> None:
    """Raise a 507 problem if accepting that many bytes would eat into the reserve."""
    if free_mb(settings) - incoming_bytes / BYTES_PER_MEGABYTE < settings.disk_reserve_mb:
        raise disk_full()
    keep_ballast(settings)


def keep_ballast(settings: Settings) -> None:
    """Make the file that is given up when the disk is full, if it is not there and there is room for it. It is asked for
    before anything new is accepted, so that nothing new takes its place."""
    path = _ballast(settings)
    if path.exists() or free_mb(settings) < 2 * BALLAST_MB:
        return
    with suppress(OSError):  # without it, only erasing on a full disk is at risk
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT, 0o600)
        try:
            os.posix_fallocate(descriptor, 0, BALLAST_MB * BYTES_PER_MEGABYTE)
        except OSError:
            path.unlink(missing_ok=True)  # what is too small would be taken for it ever after
        finally:
            os.close(descriptor)


def make_room(settings: Settings) -> None:
    """Give that file up if the disk is full: what comes next is to erase something."""
    if free_mb(settings) < BALLAST_MB:
        with suppress(OSError):
            _ballast(settings).unlink(missing_ok=True)


def _ballast(settings: Settings) -> Path:
    return settings.data_dir / "ballast"
