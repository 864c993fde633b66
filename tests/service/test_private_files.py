"""What the service keeps is for its owner's eyes alone, whoever made the data folder and however."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from running import Running

CLOSED = ("galatea.db", "galatea.db-wal", "galatea.db-shm", "ballast", "redis", "redis/appendonly.aof")


def test_database_and_queue_are_readable_by_their_owner_alone(
    start: Callable[..., Running], tmp_path: Path, picture: bytes
) -> None:
    data = tmp_path / "data"
    (data / "redis").mkdir(parents=True)
    for name in ("galatea.db", "redis/appendonly.aof"):  # as a release before left them
        (data / name).touch()
        (data / name).chmod(0o644)
    for folder in (data, data / "redis"):
        folder.chmod(0o755)
    before = os.umask(0o022)
    try:
        running = start(data)
    finally:
        os.umask(before)
    running.until(running.submit(picture)["id"], "succeeded")
    modes = {name: (data / name).stat().st_mode & 0o077 for name in CLOSED}
    assert modes == dict.fromkeys(CLOSED, 0)
