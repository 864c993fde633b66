"""SQLite: a file in write-ahead mode, for one machine.

A writing transaction takes the write lock at once (`BEGIN IMMEDIATE`): one that reads first and writes later could
otherwise find its snapshot stale and fail.
"""

from __future__ import annotations

import fcntl
import os
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import IO, Any

import structlog
from sqlalchemy import create_engine, event
from sqlalchemy.engine import Connection, Engine, make_url
from sqlalchemy.exc import TimeoutError

from service.database.fair_lock import FairLock

LOCK_TIMEOUT_SECONDS = 15
"""How long a transaction waits for another to end."""
EMPTYING_MILLISECONDS = 50
"""How long the emptying of the log waits for those who read."""
EMPTYING_TRIES = 20
EMPTYING_PAUSE_SECONDS = 0.25


def engine(url: str, connections: int) -> Engine:
    """Connections to the file. (Their number is SQLAlchemy's own: a file has no server to be gentle with.)"""
    made = _connections(url)

    @event.listens_for(made, "connect")
    def use(_: Any, record: Any) -> None:
        record.info["in_use"] = _in_use(url)

    @event.listens_for(made, "close")
    def leave(_: Any, record: Any) -> None:
        if (lock := record.info.pop("in_use", None)) is not None:
            lock.close()

    return made


def _connections(url: str) -> Engine:
    _keep_to_owner(url)
    made = create_engine(url, connect_args={"timeout": LOCK_TIMEOUT_SECONDS})

    @event.listens_for(made, "connect")
    def prepare(connection: Any, _: Any) -> None:
        connection.isolation_level = None  # the transactions below are ours, not the driver's
        for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "secure_delete=ON"):
            connection.execute(f"PRAGMA {pragma}").close()

    @event.listens_for(made, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("galatea_writes", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return made


def writers() -> Callable[[], AbstractContextManager[None]]:
    """What a writing transaction is done within: those of one process take turns, as they came. SQLite itself would let
    each ask again and again, and under load the unlucky ones for seconds."""
    lock = FairLock()

    @contextmanager
    def turn() -> Iterator[None]:
        with lock.turn(LOCK_TIMEOUT_SECONDS) as came:
            if not came:
                raise TimeoutError("the database is locked: others write")
            yield

    return turn


@contextmanager
def alone(url: str) -> Iterator[Connection]:
    """A connection for changing the tables; others who ask for one wait. Makes the file's folder."""
    path = make_url(url).database or ""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    opened = _connections(url)
    with Path(f"{path}.upgrade").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with opened.connect() as connection:
            # Tables are changed by making them anew; dropping the old one must not erase what points at it.
            connection.connection.execute("PRAGMA foreign_keys=OFF")
            yield connection
    opened.dispose()


@contextmanager
def unused(url: str, connection: Connection) -> Iterator[bool]:
    """Whether nobody has the database open but by `alone`; until the block ends, nobody opens it then."""
    with _uses(url).open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        else:
            yield True


def _keep_to_owner(url: str) -> None:
    """Let nobody but its owner read the file; SQLite makes the files beside it (`-wal`, `-shm`) like it."""
    path = Path(make_url(url).database or "")
    if not path.parent.is_dir():
        return  # it is made with its folder, for changing the tables
    with suppress(OSError):  # one that belongs to another user stays as that user wants it
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600))
        for one in (path, *(path.with_name(path.name + end) for end in ("-wal", "-shm"))):
            if one.exists():
                one.chmod(0o600)


def _in_use(url: str) -> IO[str]:
    """The lock that every connection shares with the others for as long as it is open: `unused` asks for it alone. The
    system gives it back when a process ends, in whatever way."""
    lock = _uses(url).open("w")
    deadline = time.monotonic() + LOCK_TIMEOUT_SECONDS
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                lock.close()
                raise sqlite3.OperationalError("database is locked: its tables are being changed") from None
            time.sleep(0.1)
        else:
            return lock


def _uses(url: str) -> Path:
    return Path(f"{make_url(url).database}.used")


def tidy(connection: Connection) -> None:
    """Write the log back into the file and empty it, so that what was erased is nowhere on disk; if somebody reads all
    the while, the next time does it.

    Emptying keeps all writers out while it waits for the readers: it asks often, and never waits for long.
    """
    cursor = connection.connection.cursor()
    cursor.execute("PRAGMA wal_checkpoint(PASSIVE)")  # most of the work, and nobody waits for it
    cursor.execute(f"PRAGMA busy_timeout={EMPTYING_MILLISECONDS}")
    try:
        for _ in range(EMPTYING_TRIES):
            busy, _, _ = cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()
            if not busy:
                return
            time.sleep(EMPTYING_PAUSE_SECONDS)
        structlog.get_logger().info("log_not_emptied", why="somebody was reading or writing all the while")
    finally:
        cursor.execute(f"PRAGMA busy_timeout={LOCK_TIMEOUT_SECONDS * 1000}")
