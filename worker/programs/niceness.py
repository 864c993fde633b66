"""What computes gives way to what answers: the API stays quick while all cores work."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path


def lower_priority(process: int, niceness: int) -> None:
    """Rank a process that leads a session of its own below those that are less nice (0 is what most are).

    Where Linux groups processes by session (`kernel.sched_autogroup_enabled`, on by default), a process's own niceness
    counts among its session alone, and each session has an equal share of the cores: the session has to be ranked, too.
    """
    os.setpriority(os.PRIO_PROCESS, process, niceness)
    with suppress(OSError):  # a kernel without groups, or a /proc that cannot be written to
        Path(f"/proc/{process}/autogroup").write_text(str(niceness))
