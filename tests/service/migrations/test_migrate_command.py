"""`galatea migrate` beside a service that runs, and after it has stopped."""

from __future__ import annotations

import gc
from collections.abc import Callable
from pathlib import Path

from galatea_command import galatea
from running import Running


def test_the_tables_stay_as_they_are_under_a_service(start: Callable[..., Running], picture: bytes) -> None:
    running = start()
    for arguments in (["0005"], ["0005", "--down"], ["base", "--down"]):
        refused = galatea(running.data_dir, "migrate", *arguments)
        assert refused.exit_code == 2, refused.stderr
        assert "Nothing was done" in refused.stderr
    newest = galatea(running.data_dir, "migrate")
    assert newest.exit_code == 0, newest.stderr
    job = running.until(running.submit(picture)["id"], "succeeded")
    running.stop()

    refused = galatea(running.data_dir, "migrate", "0010")
    assert refused.exit_code == 2
    assert "the table motions" in refused.stderr and "--down" in refused.stderr
    assert galatea(running.data_dir, "migrate").stdout == newest.stdout, "the tables are as they were"
    done = galatea(running.data_dir, "migrate", "0010", "--down")
    assert (done.exit_code, done.stdout) == (0, "The tables are at version 0010.\n")
    assert "erases" in done.stderr and "the table motions" in done.stderr
    running.start()
    assert running.job(job["id"])["status"] == "succeeded", "a service brings the tables up again"


def test_a_command_has_let_go_of_the_database_when_it_ends(tmp_path: Path) -> None:
    gc.disable()  # whose time to come is not ours to choose
    try:
        assert galatea(tmp_path, "migrate").exit_code == 0
        assert galatea(tmp_path, "keys", "list").exit_code == 0
        assert galatea(tmp_path, "migrate", "0010").exit_code == 2, "an error keeps nothing open either"
        done = galatea(tmp_path, "migrate", "0010", "--down")
        assert (done.exit_code, done.stdout) == (0, "The tables are at version 0010.\n")
    finally:
        gc.enable()
