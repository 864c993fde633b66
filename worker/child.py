"""The process that does the work: it waits for one job after another and runs the engine.

It reads commands from its standard input and writes what happens to the file descriptor named in its arguments,
both as JSON, one object a line. It knows no database, no queue and no storage; it gets paths and limits.
A hostile input that takes it over or brings it down costs this process and nothing else.
"""

from __future__ import annotations

import ctypes
import json
import os
import queue
import resource
import sys
import tempfile
import threading
import traceback
from collections.abc import Mapping
from errno import EDQUOT, EFBIG, ENOSPC
from pathlib import Path
from typing import Any, BinaryIO

from engine.errors import Canceled, InputError
from engine.kind import Kind
from engine.media.limits import Limits
from engine.run import Progress, Run
from engine.store import StageStore
from service.kinds import library
from service.kinds.registry import load_kinds
from worker.tether import die_with_parent

PR_SET_NO_NEW_PRIVS = 38
NICENESS = 5
"""The API stays quick while all cores work."""


class Wire:
    """The way back to the worker."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self._lock = threading.Lock()

    def send(self, event: str, **data: Any) -> None:
        with self._lock:
            self._file.write(json.dumps({"event": event, **data}).encode() + b"\n")
            self._file.flush()


class ReportingStore(StageStore):
    """A store that tells the worker of each new stage: an attempt that stored one was not in vain."""

    def __init__(self, folder: Path, wire: Wire):
        super().__init__(folder)
        self._wire = wire

    def save(self, key: str, output: Any, notices: Any = ()) -> None:
        super().save(key, output, notices)
        self._wire.send("stored")


def perform(job: Mapping[str, Any], kinds: Mapping[str, Kind], wire: Wire, canceled: threading.Event) -> dict[str, Any]:
    """Run one job. Returns how it ended: `{"outcome": "succeeded" | "canceled"}`, or `failed` with code and detail;
    `clean` where nothing unforeseen happened, so that this process can go on to the next job."""
    out, temporary = Path(job["out"]), Path(job["temporary"])
    os.environ["TMPDIR"] = tempfile.tempdir = str(temporary)
    os.chdir(temporary)

    def report(progress: Progress) -> None:
        wire.send("progress", stage=progress.stage, fraction=progress.fraction, message=progress.message)

    try:
        kind = kinds[job["kind"]]
        run = Run(
            store=ReportingStore(Path(job["stages"]), wire),
            shared=ReportingStore(Path(job["shared"]), wire),
            on_progress=report,
            canceled=canceled.is_set,
            on_artifact=lambda path: wire.send("artifact", name=path.name),
            limits=Limits(**job["limits"]),
        )
        inputs = {name: _local(source) for name, source in job["inputs"].items()}
        kind.work(inputs, kind.options.model_validate(job["options"]), out, run)
    except Canceled:
        return {"outcome": "canceled", "clean": True}
    except InputError as error:
        return failed(error.code, error.detail, error.correctable) | {"clean": True}
    except Exception as error:
        traceback.print_exc()
        return _unexpected(error)
    return {"outcome": "succeeded", "clean": True}


def failed(code: str, detail: str, correctable: tuple[str, ...] = ()) -> dict[str, Any]:
    return {"outcome": "failed", "code": code, "detail": detail, "correctable": list(correctable)}


def _local(source: Any) -> Any:
    if isinstance(source, list):
        return tuple(_local(one) for one in source)
    return library.item(source["library"], source["name"]) if isinstance(source, dict) else Path(source)


def _unexpected(error: BaseException) -> dict[str, Any]:
    """What went wrong that is no `InputError`: out of memory or disk where it can be told, otherwise a bug."""
    link: BaseException | None = error
    while link is not None:
        if isinstance(link, MemoryError) or getattr(link, "code", None) == -4:  # OpenCV's StsNoMem
            return failed("out_of_memory", "The job needs more memory than a job may use: send a smaller input.")
        number = getattr(link, "errno", None)
        if number in (ENOSPC, EDQUOT):
            return failed("disk_full", "The disk became full during the job: free space and submit it again.")
        if number == EFBIG:
            return failed("file_limit", "The job writes a larger file than a job may write: ask for a smaller result.")
        link = link.__cause__ or link.__context__
    return failed("internal_error", "The job met a fault of the program; the worker's log says which.")


def confine(memory_bytes: int, file_bytes: int) -> None:
    """Set the limits of this process: memory, size of files, no core dumps, no new privileges; the first to go when
    the machine itself runs out of memory."""
    resource.setrlimit(resource.RLIMIT_DATA, (memory_bytes, memory_bytes))
    resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    ctypes.CDLL(None).prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    Path("/proc/self/oom_score_adj").write_text("1000")
    os.nice(NICENESS)


def main() -> None:
    """`python -m worker.child PARENT_PID WIRE_FD MEMORY_BYTES FILE_BYTES KIND...`"""
    parent, wire_fd, memory_bytes, file_bytes = map(int, sys.argv[1:5])
    die_with_parent(parent)
    confine(memory_bytes, file_bytes)
    commands = os.fdopen(os.dup(0), "rb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    wire = Wire(os.fdopen(wire_fd, "wb"))
    kinds = load_kinds(sys.argv[5:])
    jobs: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    canceled = threading.Event()

    def listen() -> None:
        for line in commands:
            command = json.loads(line)
            if command["command"] == "cancel":
                canceled.set()
            else:
                canceled.clear()
                jobs.put(command)
        os._exit(0)  # the worker is gone or wants no more of this process

    threading.Thread(target=listen, daemon=True).start()
    for kind in kinds.values():
        if kind.prepare is not None:
            kind.prepare()
    wire.send("ready")
    while True:
        job = jobs.get()
        wire.send("end", **perform(job, kinds, wire, canceled))


if __name__ == "__main__":
    main()
