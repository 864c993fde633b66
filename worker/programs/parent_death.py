"""Processes that do not outlive the one that started them, however that one ends (Linux).

Run as a script, it ties itself to its parent and becomes another program:
`python parent_death.py PARENT_PID SIGNAL PROGRAM ARGUMENT...`. It imports nothing of ours, so that it starts at once.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1


def die_with_parent(parent: int, with_signal: int = signal.SIGKILL) -> None:
    """Let the kernel send this process a signal when the thread that started it ends; exit if it has already."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.prctl(PR_SET_PDEATHSIG, int(with_signal), 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")
    if os.getppid() != parent:
        os._exit(1)


def tied_command(command: list[str], with_signal: int = signal.SIGKILL) -> list[str]:
    """The command that runs `command` tied to this process."""
    return [sys.executable, "-I", "-S", __file__, str(os.getpid()), str(int(with_signal)), *command]


if __name__ == "__main__":
    die_with_parent(int(sys.argv[1]), int(sys.argv[2]))
    os.execv(sys.argv[3], sys.argv[3:])  # noqa: S606
