"""What stands in the way at the start is told in one line that says what to do, and the command fails."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from servers import PostgresServer, free_port
from sqlalchemy import text

from service.database.sessions import Database

ROOT = Path(__file__).parent.parent.parent


def galatea(folder: Path, *command: str, **settings: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    environment |= {"GALATEA_DATA_DIR": str(folder), **{f"GALATEA_{n.upper()}": v for n, v in settings.items()}}
    return subprocess.run(
        [sys.executable, "-m", "shell.main", *command], env=environment, cwd=ROOT, capture_output=True, text=True
    )


def error_line(done: subprocess.CompletedProcess[str]) -> str:
    """The one line that a command left."""
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    lines = [line for line in done.stderr.splitlines() if line.startswith("Error: ")]
    assert len(lines) == 1, done.stderr
    return lines[0]


@pytest.mark.parametrize("command", [("serve", "--port", "0"), ("worker",)], ids=["serve", "worker"])
def test_a_database_that_is_not_there(tmp_path: Path, command: tuple[str, ...]) -> None:
    port = free_port()
    said = error_line(galatea(tmp_path, *command, database_url=f"postgresql://galatea:s3cret@127.0.0.1:{port}/galatea"))
    assert f"127.0.0.1:{port}/galatea cannot be reached" in said and "GALATEA_DATABASE_URL" in said
    assert "s3cret" not in said


def test_a_database_that_refuses(tmp_path: Path, postgres: PostgresServer) -> None:
    url = postgres.new_database()
    done = galatea(tmp_path, "worker", database_url=url.rpartition("/")[0] + "/nothing")
    assert "refuses" in error_line(done) and "nothing" in error_line(done)


@pytest.mark.parametrize("command", [("serve", "--port", "0"), ("worker",)], ids=["serve", "worker"])
def test_kinds_that_are_not_there(tmp_path: Path, command: tuple[str, ...]) -> None:
    assert error_line(galatea(tmp_path, *command, worker_kinds="portrait,potrait")).startswith(
        "Error: GALATEA_WORKER_KINDS: there is no job kind potrait; there are portrait"
    )
    said = error_line(galatea(tmp_path, *command, kinds="no_such_module:KIND"))
    assert "GALATEA_KINDS: No module named 'no_such_module'" in said


def test_the_doctor_finds_both(tmp_path: Path) -> None:
    url = f"postgresql://galatea:s3cret@127.0.0.1:{free_port()}/galatea"
    done = galatea(tmp_path, "doctor", database_url=url, worker_kinds="potrait")
    assert done.returncode == 1
    assert "cannot be reached: start it" in done.stdout and "there is no job kind potrait" in done.stdout
    assert "s3cret" not in done.stdout


def test_tables_of_a_newer_release(tmp_path: Path) -> None:
    database = Database(f"sqlite:///{tmp_path / 'galatea.db'}")
    database.upgrade()
    with database.write() as session:
        session.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    database.close()
    assert "not of this release" in error_line(galatea(tmp_path, "worker"))


def test_a_data_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "Set GALATEA_DATA_DIR" in error_line(galatea(tmp_path / "file" / "data", "worker"))
