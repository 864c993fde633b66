"""Signs of life of the workers on this machine: each touches a file of its own, and who watches looks how long ago.

The files carry moments of the machine's monotonic clock, which is the same in all its processes: the time of day may jump.
A process that is frozen is known by its silence, and by nothing else: it has not ended, and says so little as one at work.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

PULSE_FOLDER = "workers"
BEAT_SECONDS = 1.0
PULSE_FORGOTTEN_SECONDS = 3600.0


def worker_name(host: str, process: int) -> str:
    """The name of a worker, unique among all machines."""
    return f"{host}:{process}"


class Pulse:
    """A worker's own sign of life."""

    def __init__(self, data_dir: Path, name: str):
        self._file = data_dir / PULSE_FOLDER / name
        self._file.parent.mkdir(parents=True, exist_ok=True)
        for left in self._file.parent.iterdir():  # by workers that were killed
            if not 0 <= _silence(left) < PULSE_FORGOTTEN_SECONDS:
                left.unlink(missing_ok=True)

    def beat(self) -> None:
        if not self._file.exists():  # `touch` leaves the time of day for a moment, which looks like no sign at all
            self._file.touch()
        moment = time.monotonic_ns()
        os.utime(self._file, ns=(moment, moment))

    def end(self) -> None:
        """There is nothing more to hear."""
        self._file.unlink(missing_ok=True)


def silent_seconds(data_dir: Path, name: str) -> float:
    """For how many seconds nothing was heard of a worker; infinite where it was never heard."""
    return _silence(data_dir / PULSE_FOLDER / name)


def least_silent_seconds(data_dir: Path) -> float:
    """For how many seconds nothing was heard of the worker on this machine that was heard last."""
    folder = data_dir / PULSE_FOLDER
    return min(map(_silence, folder.iterdir()), default=float("inf")) if folder.is_dir() else float("inf")


def _silence(file: Path) -> float:
    try:
        beaten = file.stat().st_mtime_ns
    except OSError:  # mostly because it is not there
        return float("inf")
    seconds = (time.monotonic_ns() - beaten) / 1e9
    return seconds if seconds >= 0 else float("inf")  # from before the machine was started anew
