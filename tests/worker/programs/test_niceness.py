"""What computes gives way to what answers."""

from __future__ import annotations

import subprocess
from pathlib import Path

import psutil

from worker.programs.niceness import lower_priority


def test_a_process_and_its_session_rank_below_others() -> None:
    with subprocess.Popen(["/bin/sleep", "60"], start_new_session=True) as sleeping:
        try:
            lower_priority(sleeping.pid, 7)
            assert psutil.Process(sleeping.pid).nice() == 7
            session = Path(f"/proc/{sleeping.pid}/autogroup")  # where the kernel has none, there is nothing to rank
            assert not session.exists() or session.read_text().split()[-1] == "7"
        finally:
            sleeping.kill()
