"""A database with the newest tables and nothing in them: who starts a service or opens a context finds it as an earlier start
would have left it. It is made once for each process of the tests and copied: all versions one after another take a quarter of
a second. The way from nothing to there is told by the tests of migrations and of the database, which begin with nothing."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

from service.database.sessions import Database


def make_tables(url: str) -> None:
    """Bring an empty database to the newest version."""
    database = Database(url)
    database.upgrade()
    database.close()


@cache
def _file() -> bytes:
    with tempfile.TemporaryDirectory(prefix="galatea-tables-") as folder:
        path = Path(folder) / "galatea.db"
        make_tables(f"sqlite:///{path}")
        return path.read_bytes()


def write_newest_tables(path: Path) -> None:
    """Write the SQLite file, for its owner alone as the service does."""
    path.touch(mode=0o600, exist_ok=False)
    path.write_bytes(_file())


def lay_out_data_folder(data_dir: Path) -> None:
    """Make a data folder with the database in it, where there is none yet."""
    if not data_dir.exists():
        data_dir.mkdir(mode=0o700, parents=True)
        write_newest_tables(data_dir / "galatea.db")
