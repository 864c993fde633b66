"""How a process died is told from the status that the system gives, and whether it was its own doing."""

from __future__ import annotations

import os
import subprocess

import pytest

from worker.job_process.exit_reason import death_in_words, death_name, own_death


def status_of(command: str) -> int:
    """What `os.wait` tells of a shell that does this."""
    with subprocess.Popen(["/bin/sh", "-c", command]) as process:
        _, status = os.waitpid(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return status


@pytest.mark.parametrize(
    ("command", "death", "own"),
    [
        ("exit 0", None, None),
        ("exit 3", "exit 3", "exit 3"),
        ("kill -ABRT $$", "SIGABRT", "SIGABRT"),
        ("kill -SEGV $$", "SIGSEGV", "SIGSEGV"),
        ("kill -KILL $$", "SIGKILL", None),
        ("kill -TERM $$", "SIGTERM", None),
        ("kill -40 $$", "signal 40", "signal 40"),
    ],
)
def test_a_death_has_the_same_short_name_each_time_and_may_have_come_from_outside(
    command: str, death: str | None, own: str | None
) -> None:
    found = death_name(status_of(command))
    assert found == death
    assert own_death(found) == own


def test_every_death_has_words_that_say_which_it_was() -> None:
    words = [death_in_words(one) for one in (None, "exit 3", "SIGABRT", "SIGSEGV", "SIGKILL", "SIGXCPU", "signal 40")]
    assert len(set(words)) == len(words)
    for word, death in zip(
        words[1:], ("status 3", "SIGABRT", "SIGSEGV", "SIGKILL", "SIGXCPU", "signal 40"), strict=True
    ):
        assert death in word
