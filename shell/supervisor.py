"""Keeping the processes of `galatea serve` alive: started, watched, started again, stopped together.

One that is frozen has not ended, and would never be missed: those that give signs of life are killed when they fall silent,
and started again.

All are started by one thread that lives as long as this process: each is tied to it and ends with it, even
if it is killed.
"""

from __future__ import annotations

import signal
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import structlog

from worker.programs.interpreter import module_environment
from worker.programs.parent_death import tied_command

CHILD_POLL_SECONDS = 0.2
MAX_RESTART_PAUSE_SECONDS = 30.0
STEADY_SECONDS = 60.0
"""A process that lived this long is started again without a pause, should it end."""

LISTEN_SECONDS = 1.0
MAX_START_SECONDS = 120.0
"""How long a process may take to give its first sign of life."""

LATE_SECONDS = 5.0
"""A look that comes so late shows that this process was frozen itself: what it did not hear then means nothing."""


@dataclass
class Program:
    """A process to keep alive."""

    name: str
    command: Sequence[str]
    stop_seconds: float
    """How long it may take to stop before it is killed."""
    lives: Callable[[int], bool] | None = None
    """Whether the process of this number gives a sign of life, said within a few seconds; None where it gives none."""
    heard: float = 0.0
    process: subprocess.Popen[bytes] | None = None
    started: float = 0.0
    pause: float = 0.0
    wanted: bool = field(default=False)


class Supervisor:
    """Keeps programs alive."""

    def __init__(self, silent_seconds: float, inherited: Sequence[int] = ()):
        """`silent_seconds` is how long a program may give no sign of life; `inherited` are open file descriptors that
        every program shares (a lock that lasts as long as they do)."""
        self._silent_seconds = silent_seconds
        self._inherited = inherited
        self._looked = self._attentive = time.monotonic()
        self._programs: list[Program] = []
        self._lock = threading.Lock()
        self._another = threading.Event()
        threading.Thread(target=self._watch, name="supervisor", daemon=True).start()

    def keep(
        self, name: str, command: Sequence[str], stop_seconds: float, lives: Callable[[int], bool] | None = None
    ) -> None:
        """Start a program and keep it alive from now on."""
        program = Program(name, command, stop_seconds, lives, wanted=True)
        with self._lock:
            self._programs.append(program)
        self._another.set()
        if lives is not None:
            threading.Thread(target=self._listen, args=[program, lives], name=f"listen-{name}", daemon=True).start()

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
            moment = time.monotonic()
            if moment - self._looked > LATE_SECONDS:
                self._attentive = moment
            self._looked = moment
            with self._lock:
                for program in self._programs:
                    if program.wanted:
                        self._tend(program)
            self._another.wait(CHILD_POLL_SECONDS)
            self._another.clear()

    def _tend(self, program: Program) -> None:
        moment = time.monotonic()
        if program.process is None or program.process.poll() is not None:
            if program.process is not None and program.pause == 0.0:
                structlog.get_logger().warning("program_ended", program=program.name, code=program.process.returncode)
            if moment - program.started < program.pause:
                return
            steady = moment - program.started > STEADY_SECONDS
            program.pause = 0.5 if steady else min(max(program.pause * 2, 0.5), MAX_RESTART_PAUSE_SECONDS)
            program.started = moment
            program.process = subprocess.Popen(  # noqa: S603  (our own programs)
                tied_command(list(program.command), signal.SIGTERM),
                pass_fds=self._inherited,
                stdin=subprocess.DEVNULL,
                env=module_environment(),
                start_new_session=True,
            )
            return
        if moment - program.started > STEADY_SECONDS:
            program.pause = 0.0
        if program.lives is not None and (silence := self._silence(program, moment)) > self._silent_seconds:
            structlog.get_logger().error("program_frozen", program=program.name, silent_seconds=round(silence, 1))
            program.process.kill()
            program.process.wait()

    def _silence(self, program: Program, moment: float) -> float:
        """For how many seconds a program has owed a sign of life."""
        heard = program.heard if program.heard > program.started else program.started + MAX_START_SECONDS
        return moment - max(heard, self._attentive)

    def _listen(self, program: Program, lives: Callable[[int], bool]) -> None:
        while True:
            process = program.process
            if process is not None and process.returncode is None and lives(process.pid):
                program.heard = time.monotonic()
            time.sleep(LISTEN_SECONDS)
