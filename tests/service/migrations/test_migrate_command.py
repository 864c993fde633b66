"""`galatea migrate` beside a service that runs, and after it has stopped."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from running import Running


def migrate(running: Running, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
    environment |= {"GALATEA_DATA_DIR": str(running.data_dir)}
    command = [sys.executable, "-m", "shell.main", "migrate", *arguments]
    root = Path(__file__).parents[3]
    return subprocess.run(command, env=environment, cwd=root, capture_output=True, text=True, timeout=300)


def test_the_tables_stay_as_they_are_under_a_service(start: Callable[..., Running], picture: bytes) -> None:
    running = start()
    for arguments in (["0005"], ["0005", "--down"], ["base", "--down"]):
        refused = migrate(running, *arguments)
        assert refused.returncode == 2, refused.stderr
        assert "Nothing was done" in refused.stderr
    newest = migrate(running)
    assert newest.returncode == 0, newest.stderr
    job = running.until(running.submit(picture)["id"], "succeeded")
    running.stop()

    refused = migrate(running, "0010")
    assert refused.returncode == 2
    assert "the table motions" in refused.stderr and "--down" in refused.stderr
    assert migrate(running).stdout == newest.stdout, "the tables are as they were"
    done = migrate(running, "0010", "--down")
    assert (done.returncode, done.stdout) == (0, "The tables are at version 0010.\n")
    assert "erases" in done.stderr and "the table motions" in done.stderr
    running.start()
    assert running.job(job["id"])["status"] == "succeeded", "a service brings the tables up again"
