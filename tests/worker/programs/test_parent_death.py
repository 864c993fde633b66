"""Processes end with the one that started them, however that one ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import psutil
import pytest

from worker.programs.parent_death import tied_command


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_tied_process_ends_with_its_parent(number: signal.Signals) -> None:
    command = tied_command(["/bin/sleep", "60"])
    script = f"import os, subprocess; p = subprocess.Popen({command!r}); print(p.pid, flush=True); p.wait()"
    # `tied_command` names the process that calls it as the parent; here that is the script.
    script = script.replace(repr(str(os.getpid())), "str(os.getpid())")
    parent = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert parent.stdout is not None
    child = psutil.Process(int(parent.stdout.readline()))
    deadline = time.monotonic() + 90
    while "sleep" not in child.name() and time.monotonic() < deadline:
        time.sleep(0.02)
    parent.send_signal(number)
    parent.wait(90)
    psutil.wait_procs([child], timeout=90)
    assert not child.is_running()
