"""Free space, and the reserve below which nothing new is accepted."""

from __future__ import annotations

import shutil

from service.problems import disk_full
from service.settings import MEGABYTE, Settings


def free_mb(settings: Settings) -> float:
    """Free space where the data lie, in megabytes."""
    return shutil.disk_usage(settings.data_dir).free / MEGABYTE


def require_space(settings: Settings, incoming_bytes: int = 0) -> None:
    """Raise a 507 problem if accepting that many bytes would eat into the reserve."""
    if free_mb(settings) - incoming_bytes / MEGABYTE < settings.disk_reserve_mb:
        raise disk_full()
