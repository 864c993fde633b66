"""Keeping the processes of `galatea serve` alive: started, watched, started again, stopped together.

All are started by one thread that lives as long as this process: each is tethered to it and ends with it, even
if it is killed.
"""

from __future__ import annotations

import signal
import subprocess
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import structlog

from worker.interpreter import module_environment
from worker.tether import tethered

LOOK_SECONDS = 0.2
LONGEST_PAUSE = 30.0
STEADY_SECONDS = 60.0
"""A process that lived this long is started again without a pause, should it end."""


@dataclass
class Program:
    """A process to keep alive."""

    name: str
    command: Sequence[str]
    stop_seconds: float
    """How long it may take to stop before it is killed."""
    process: subprocess.Popen[bytes] | None = None
    started: float = 0.0
    pause: float = 0.0
    wanted: bool = field(default=False)


class Supervisor:
    """Keeps programs alive."""

    def __init__(self, inherited: Sequence[int] = ()):
        """`inherited` are open file descriptors that every program shares (a lock that lasts as long as they do)."""
        self._inherited = inherited
        self._programs: list[Program] = []
        self._lock = threading.Lock()
        threading.Thread(target=self._watch, name="supervisor", daemon=True).start()

    def keep(self, name: str, command: Sequence[str], stop_seconds: float) -> None:
        """Start a program and keep it alive from now on."""
        with self._lock:
            self._programs.append(Program(name, command, stop_seconds, wanted=True))

    def stop(self) -> None:
        """Stop all programs, the last one first, and kill those that take too long."""
        with self._lock:
            for program in self._programs:
                program.wanted = False
        for program in reversed(self._programs):
            if program.process is None:
                continue
            program.process.send_signal(signal.SIGTERM)
            try:
                program.process.wait(program.stop_seconds)
            except subprocess.TimeoutExpired:
                structlog.get_logger().warning("program_killed", program=program.name)
                program.process.kill()
                program.process.wait()

    def _watch(self) -> None:
        while True:
            with self._lock:
                for program in self._programs:
                    if program.wanted:
                        self._tend(program)
            time.sleep(LOOK_SECONDS)

    def _tend(self, program: Program) -> None:
        moment = time.monotonic()
        if program.process is None or program.process.poll() is not None:
            if program.process is not None and program.pause == 0.0:
                structlog.get_logger().warning("program_ended", program=program.name, code=program.process.returncode)
            if moment - program.started < program.pause:
                return
            steady = moment - program.started > STEADY_SECONDS
            program.pause = 0.5 if steady else min(max(program.pause * 2, 0.5), LONGEST_PAUSE)
            program.started = moment
            program.process = subprocess.Popen(  # noqa: S603  (our own programs)
                tethered(list(program.command), signal.SIGTERM),
                pass_fds=self._inherited,
                stdin=subprocess.DEVNULL,
                env=module_environment(),
                start_new_session=True,
            )
        elif moment - program.started > STEADY_SECONDS:
            program.pause = 0.0
