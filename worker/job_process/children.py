"""The worker's side of the processes that do the work: starting them warm, talking to them, ending them."""

from __future__ import annotations

import json
import os
import selectors
import subprocess
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from signal import SIGKILL
from typing import Any

import structlog

from engine.perception.models import MODEL_SETTINGS
from service.settings import BYTES_PER_MEGABYTE, Settings
from worker.programs.interpreter import module_command, module_environment
from worker.programs.niceness import lower_priority
from worker.sandbox.confinement import Limits

MAX_EVENT_BYTES = 1_000_000
PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


class ChildLost(Exception):
    """The process ended, or speaks nonsense."""


class Child:
    """One process that forks another for each job, one after another (see `worker.job_process.child`)."""

    def __init__(self, settings: Settings, user: int | None = None, turn: int = 0, kinds: Sequence[str] = ()):
        """`user` is who its jobs work as. By its `turn` several processes share the cores evenly. `kinds` are those
        that it is to be ready for, all if there are none."""
        self._ended = False
        self._job: int | None = None
        self.worked_on: set[str] = set()
        """The kinds of the jobs that it has had."""
        self._log = tempfile.TemporaryFile(mode="a+b")  # noqa: SIM115  (open as long as the process lives)
        read_end, write_end = os.pipe()
        try:
            self._process = subprocess.Popen(  # noqa: S603  (our own program)
                module_command(
                    "worker.job_process.child",
                    str(os.getpid()),
                    str(write_end),
                    json.dumps(asdict(process_limits(settings, user))),
                    ",".join(kinds),
                    *settings.kinds,
                ),
                stdin=subprocess.PIPE,
                stdout=self._log,
                stderr=self._log,
                pass_fds=[write_end],
                env=engine_environment(settings),
                start_new_session=True,
            )
            lower_priority(self._process.pid, settings.job_niceness)  # from its first import on
            if settings.job_cores:
                os.sched_setaffinity(self._process.pid, _cores(settings, turn))
        except BaseException:
            os.close(read_end)
            raise
        finally:
            os.close(write_end)
        self._read_end = read_end
        self._buffer = b""
        os.set_blocking(read_end, False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(read_end, selectors.EVENT_READ)

    @property
    def pid(self) -> int:
        return self._process.pid

    def lives(self) -> bool:
        """Whether it has not ended, nor been stopped."""
        return self._process.poll() is None and not self.stopped()

    def stopped(self) -> bool:
        """Whether it, or the process of its job, was stopped by a signal and does not go on."""
        return any(_state(process) in ("T", "t") for process in {self.pid, self._job or self.pid})

    def send(self, command: Mapping[str, Any]) -> None:
        """Give it a command. Raises `ChildLost`."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(command).encode() + b"\n")
            self._process.stdin.flush()
        except OSError as error:
            raise ChildLost(self.exit_reason()) from error

    def receive(self, timeout: float) -> list[dict[str, Any]]:
        """What it has said, waiting up to `timeout` seconds for something. Raises `ChildLost`."""
        if not self._selector.select(timeout):
            return []
        data = os.read(self._read_end, 1 << 16)
        if not data:
            raise ChildLost(self.exit_reason())
        *lines, self._buffer = (self._buffer + data).split(b"\n")
        if len(self._buffer) > MAX_EVENT_BYTES:
            raise ChildLost("the job's process spoke nonsense")
        try:
            said = [json.loads(line, parse_constant=_no_number) for line in lines]
        except ValueError as error:
            raise ChildLost("the job's process spoke nonsense") from error
        for event in said:
            if event["event"] in ("started", "end"):
                self._job = event.get("pid")
        return said

    def end_job(self, timeout: float) -> bool:
        """End the job that runs, now. Returns whether it is over, so that the next one may come."""
        deadline = time.monotonic() + timeout
        try:
            self.send({"command": "kill"})
            while time.monotonic() < deadline:
                if any(event["event"] == "end" for event in self.receive(0.1)):
                    return True
        except ChildLost:
            pass
        return False

    def memory_mb(self) -> float:
        """The memory that its job holds, without the files that it only maps."""
        try:
            with open(f"/proc/{self._job or self.pid}/statm") as statm:  # noqa: PTH123  (read several times a second)
                _, resident, shared = statm.read().split()[:3]
        except (OSError, ValueError):
            return 0.0
        return (int(resident) - int(shared)) * PAGE_BYTES / BYTES_PER_MEGABYTE

    def log_tail(self, size: int = 4000) -> str:
        """The last of what it printed, and forget it."""
        end = self._log.seek(0, os.SEEK_END)
        self._log.seek(max(end - size, 0))
        tail = self._log.read(size).decode(errors="replace")
        self._log.truncate(0)
        return tail

    def exit_reason(self) -> str:
        """Why it ended."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(1)
        code = self._process.returncode
        if code is None or code >= 0:
            return "the job's process ended unexpectedly"
        return f"the job's process was ended by signal {-code}"

    def kill(self) -> None:
        """End it and whatever it started, now; again is no error."""
        if self._ended:
            return
        self._ended = True
        with suppress(ProcessLookupError):
            os.killpg(self.pid, SIGKILL)
        with suppress(OSError):
            self._process.kill()
        self._process.wait()
        if self._process.stdin is not None:
            with suppress(OSError):
                self._process.stdin.close()
        self._selector.close()
        os.close(self._read_end)
        self._log.close()


class WarmChildren:
    """Keeps as many processes ready as jobs of these kinds may run at once: importing the engine takes seconds.

    One thread starts them all and lives as long as the worker, because a process that `parent_death` binds ends with the thread
    that started it.
    """

    def __init__(self, settings: Settings, count: int, kinds: Sequence[str], user: int | None = None):
        self._settings = settings
        self._count = count
        self._kinds = kinds
        self._user = user
        self._changed = threading.Condition()
        self._idle: list[Child] = []
        self._busy: set[Child] = set()
        self._outdated: set[Child] = set()
        self._closed = False
        self._started = 0
        threading.Thread(target=self._keep_warm, name="warm-children", daemon=True).start()

    def take(self) -> Child:
        """A process for one job, waiting for it to be started."""
        with self._changed:
            while True:
                self._changed.wait_for(lambda: self._idle or self._closed)
                if self._closed:
                    raise ChildLost("the worker is stopping")
                child = self._idle.pop()
                if child.lives():
                    self._busy.add(child)
                    return child
                child.kill()
                self._changed.notify_all()

    def give_back(self, child: Child, reuse: bool) -> None:
        """Return a process after its job. It is ended unless it may be used again."""
        with self._changed:
            reuse = reuse and child not in self._outdated
            self._outdated.discard(child)
        if reuse:
            child.log_tail()
        else:
            child.kill()
        with self._changed:
            self._busy.discard(child)
            if reuse and not self._closed:
                self._idle.append(child)
            elif reuse:
                child.kill()
            self._changed.notify_all()

    def renew(self) -> None:
        """Have others in place of all that are there: idle ones now, busy ones after their jobs. They find what was
        compiled since."""
        with self._changed:
            for child in self._idle:
                child.kill()
            self._idle.clear()
            self._outdated |= self._busy
            self._changed.notify_all()

    def close(self) -> None:
        """End the idle ones; the busy ones are ended by whoever holds them."""
        with self._changed:
            self._closed = True
            for child in self._idle:
                child.kill()
            self._idle.clear()
            self._changed.notify_all()

    def _keep_warm(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or len(self._idle) + len(self._busy) < self._count)
                if self._closed:
                    break
            try:
                child = Child(self._settings, self._user, self._started, self._kinds)
                self._started += 1
            except OSError:
                structlog.get_logger().exception("child_not_started")
                time.sleep(1)
                continue
            with self._changed:
                if self._closed:
                    child.kill()
                    break
                self._idle.append(child)
                self._changed.notify_all()
        threading.Event().wait()  # the processes that are still busy end with this thread


def _state(process: int) -> str | None:
    """How Linux calls what a process does (proc_pid_stat(5)); None where it is gone."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return None


def process_limits(settings: Settings, user: int | None) -> Limits:
    """What the settings bound of a job's process."""
    return Limits(
        memory_bytes=int(settings.job_memory_mb * BYTES_PER_MEGABYTE),
        file_bytes=int(settings.job_file_mb * BYTES_PER_MEGABYTE),
        cpu_seconds=int(settings.job_cpu_seconds),
        user=user,
    )


def _cores(settings: Settings, turn: int) -> list[int]:
    """The cores of a process by its turn."""
    there = sorted(os.sched_getaffinity(0))
    first = turn * settings.job_cores
    return [there[(first + i) % len(there)] for i in range(min(settings.job_cores, len(there)))]


def engine_environment(settings: Settings) -> dict[str, str]:
    """The worker's environment without its settings: passwords and addresses are not the engine's business. A model
    that the operator brings is."""
    kept = {name: value for name, value in os.environ.items() if _is_the_engines(name)}
    if settings.job_cores:
        kept |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"), str(settings.job_cores))
    return module_environment(kept)


def _is_the_engines(name: str) -> bool:
    return not name.startswith(("GALATEA_", "AWS_", "PG", "OTEL_")) or name.startswith(MODEL_SETTINGS)


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no JSON")
