"""The process that is ready before the job comes: it has loaded the engine, and forks for each job.

It reads commands from its standard input and writes what happens to the file descriptor named in its arguments, both
as JSON, one object a line. The process that it forks confines itself to its one job before it opens a stranger's file
(`worker.sandbox.confinement`), and ends with it. A hostile input that takes it over or brings it down costs that job
alone. It knows no database, no queue and no storage; it gets paths and limits.
"""

from __future__ import annotations

import json
import os
import selectors
import signal
import sys
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NoReturn

from engine.kind import Kind
from engine.perception.models import MODEL_SETTINGS
from service.catalogue.registry import load_kinds
from worker.compilation.rehearsal import compiled_folders, load_compiled
from worker.job_process import exit_reason
from worker.job_process.work import EventChannel, erased_in, failed, files_of, local, perform
from worker.programs.loading import loading
from worker.programs.parent_death import die_with_parent
from worker.sandbox.confinement import Limits, confine, keep_to_cores, limit, program_paths

MAX_COMMAND_BYTES = 1_000_000
READ_BYTES = 1 << 16
TIME_LIMIT = "time_limit"
PASSED_ON = ("progress", "stage", "stored", "artifact")
"""What a job's process may say; the rest is this process's own to say."""


class Commands:
    """Lines from a file descriptor."""

    def __init__(self, descriptor: int):
        self.descriptor = descriptor
        self._rest = b""

    def read(self) -> list[dict[str, Any]]:
        """The next ones; ends the process when the worker is gone or wants no more of it."""
        data = os.read(self.descriptor, READ_BYTES)
        if not data:
            os._exit(0)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [json.loads(line) for line in lines]


@dataclass(frozen=True)
class Ready:
    """What is there before the job comes: the kinds, what a job may do, where the program is read from."""

    kinds: Mapping[str, Kind]
    limits: Limits
    program: Sequence[Path]


class JobProcess:
    """A process that was forked for one job, and the two pipes to it."""

    def __init__(self, job: Mapping[str, Any], ready: Ready, unneeded: Sequence[int]):
        self.events, told = os.pipe()
        orders, self._orders = os.pipe()
        parent = os.getpid()
        self.pid = os.fork()
        if self.pid == 0:
            for descriptor in (self.events, self._orders, *unneeded):
                os.close(descriptor)
            _work(job, ready, parent, told, orders)
        os.close(told)
        os.close(orders)
        self._rest = b""

    def cancel(self) -> None:
        """Ask it to stop."""
        with suppress(BrokenPipeError):
            os.write(self._orders, b"x")

    def kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)  # it is not waited for yet: the number is still its own

    def read(self) -> list[dict[str, Any]] | None:
        """What it said; None once it says no more, or speaks nonsense."""
        data = os.read(self.events, READ_BYTES)
        *lines, self._rest = (self._rest + data).split(b"\n")
        try:
            said = [json.loads(line) for line in lines]
        except (ValueError, RecursionError):
            return None
        whole = all(isinstance(event, dict) and "event" in event for event in said)
        return said if data and whole and len(self._rest) < MAX_COMMAND_BYTES else None

    def end(self, cpu_seconds: int) -> str | None:
        """Make sure that it has ended. Returns why it did where that was not in order: `time_limit`, or how it
        died (`worker.job_process.exit_reason`)."""
        _, status, usage = os.wait4(self.pid, 0)
        os.close(self.events)
        os.close(self._orders)
        computed_too_long = usage.ru_utime + usage.ru_stime > cpu_seconds
        if os.WIFSIGNALED(status) and (os.WTERMSIG(status) == signal.SIGXCPU or computed_too_long):
            return TIME_LIMIT
        return exit_reason.death_name(status)


def _work(job: Mapping[str, Any], ready: Ready, parent: int, told: int, orders: int) -> NoReturn:
    """The life of a job's process."""
    code = 1
    try:
        wire = EventChannel(os.fdopen(told, "wb"))
        readable = [
            path for source in job["inputs"].values() for path in files_of(local(source)) if not erased_in(source)
        ]
        changeable = [Path(job[name]) for name in ("out", "temporary", "stages", "shared")]
        keep_to_cores(job["cores"])
        limits = replace(ready.limits, memory_bytes=min(ready.limits.memory_bytes, job["memory_bytes"]))
        confine(parent, limits, [*ready.program, *readable], changeable)
        wire.send("end", **perform(job, ready.kinds, wire, orders))
        code = 0
    finally:
        sys.stderr.flush()
        sys.stdout.flush()
        os._exit(code)


def follow(process: JobProcess, commands: Commands, wire: EventChannel, cpu_seconds: int) -> dict[str, Any]:
    """Pass on what the job's process says and what it is told, until it ends. Returns how it ended."""
    verdict: dict[str, Any] | None = None
    killed = False
    with selectors.DefaultSelector() as selector:
        for descriptor in (process.events, commands.descriptor):
            selector.register(descriptor, selectors.EVENT_READ)
        talking = True
        while talking:
            for key, _ in selector.select():
                if key.fd == commands.descriptor:
                    for command in commands.read():
                        process.cancel() if command["command"] == "cancel" else process.kill()
                        killed = killed or command["command"] == "kill"
                    continue
                said = process.read()
                talking = said is not None
                for event in said or ():
                    if event["event"] == "end":
                        verdict = event
                    elif event["event"] in PASSED_ON:
                        wire.pass_on(event)
    with suppress(ProcessLookupError):
        if verdict is None and not killed:
            _await_end(process)
        process.kill()
    why = process.end(cpu_seconds)
    if why == TIME_LIMIT:
        most = f"more than {cpu_seconds} seconds, all cores together, the most that a job may (GALATEA_JOB_CPU_SECONDS)"
        return failed("time_limit", f"The job computed for {most}: send a shorter input.")
    if verdict is None or "outcome" not in verdict:
        return {"outcome": "crashed", "reason": exit_reason.death_in_words(why), "death": exit_reason.own_death(why)}
    return verdict


def _await_end(process: JobProcess) -> None:
    """Give a process that fell silent a moment to end by itself, so that its own reason is seen."""
    with suppress(ChildProcessError), selectors.DefaultSelector() as selector:
        ended = os.pidfd_open(process.pid)
        selector.register(ended, selectors.EVENT_READ)
        selector.select(1)
        os.close(ended)


def main() -> None:
    """`python -m worker.job_process.child PARENT_PID WIRE_FD LIMITS SERVED PLACE...`: LIMITS is JSON, SERVED lists kinds by name, or is
    empty for all of those in the places."""
    parent, wire_fd = map(int, sys.argv[1:3])
    limits = Limits(**json.loads(sys.argv[3]))
    die_with_parent(parent)
    limit(limits)
    commands = Commands(os.dup(0))
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    wire = EventChannel(os.fdopen(wire_fd, "wb"))
    served = sys.argv[4].split(",") if sys.argv[4] else []
    with loading():
        kinds = {name: kind for name, kind in load_kinds(sys.argv[5:]).items() if name in served or not served}
        for kind in kinds.values():
            if kind.prepare is not None:
                kind.prepare()
        load_compiled(kinds)
        compile_without_keeping()
    models = [Path(os.environ[setting]) for setting in MODEL_SETTINGS if setting in os.environ]
    ready = Ready(kinds, limits, [*program_paths(), *compiled_folders(), *models])
    wire.send("ready")
    while True:
        for job in commands.read():
            if job["command"] != "work":
                continue  # a word to a job that has just ended
            process = JobProcess(job, ready, [commands.descriptor, wire_fd])
            wire.send("started", pid=process.pid)
            verdict = follow(process, commands, wire, limits.cpu_seconds)
            wire.pass_on(verdict | {"event": "end", "clean": True})


def compile_without_keeping() -> None:
    """What a job compiles, it compiles for itself: compiled functions are kept as pickles, which a stranger's job must
    not be able to leave for others. Those that are there already (`worker.compilation.rehearsal`) are used."""
    if "numba" in sys.modules:
        from numba.core.caching import CompileResultCacheImpl

        CompileResultCacheImpl.check_cachable = lambda self, result: False  # type: ignore[method-assign]


if __name__ == "__main__":
    main()
