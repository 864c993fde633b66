"""One job in a process of its own: the engine runs, what happens is told, the process ends."""

from __future__ import annotations

import json
import os
import select
import tempfile
import threading
import time
import traceback
from collections.abc import Callable, Mapping
from errno import EACCES, EDQUOT, EFBIG, ENOSPC, EPERM
from pathlib import Path
from typing import Any, BinaryIO

from engine.allocation import give_back_memory
from engine.errors import Canceled, InputError
from engine.kind import Candidates, Given, Kind
from engine.media.limits import Limits
from engine.package_data import IncompleteInstallation
from engine.run import Progress, Run, Turn
from engine.store import StageStore
from service.catalogue import built_in


class EventChannel:
    """A way to tell what happens: JSON, one object a line."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self._lock = threading.Lock()

    def send(self, event: str, **data: Any) -> None:
        self.pass_on({"event": event, **data})

    def pass_on(self, event: Mapping[str, Any]) -> None:
        with self._lock:
            self._file.write(json.dumps(event).encode() + b"\n")
            self._file.flush()


class ReportingStore(StageStore):
    """A store that tells the worker of each new stage: an attempt that stored one was not in vain."""

    def __init__(self, folder: Path, wire: EventChannel):
        super().__init__(folder)
        self._wire = wire

    def save(self, key: str, output: Any, notices: Any = (), kind: Any = None) -> Any:
        stored = super().save(key, output, notices, kind)
        self._wire.send("stored", key=key)
        return stored


def perform(job: Mapping[str, Any], kinds: Mapping[str, Kind], wire: EventChannel, orders: int) -> dict[str, Any]:
    """Run one job; it is canceled once something can be read from `orders`. Returns how it ended:
    `{"outcome": "succeeded" | "canceled"}`, or `failed` with code and detail."""
    out, temporary = Path(job["out"]), Path(job["temporary"])
    os.environ["TMPDIR"] = tempfile.tempdir = str(temporary)
    os.chdir(temporary)

    def report(progress: Progress) -> None:
        wire.send("progress", stage=progress.stage, fraction=progress.fraction, message=progress.message)

    def turned(name: str, turn: Turn) -> None:
        wire.send("stage", name=name, turn=turn, at=time.time())
        give_back_memory()

    try:
        kind = kinds[job["kind"]]
        with Run(
            store=ReportingStore(Path(job["stages"]), wire),
            shared=ReportingStore(Path(job["shared"]), wire),
            on_progress=report,
            canceled=_readable(orders),
            on_stage=turned,
            on_artifact=lambda path: wire.send("artifact", name=path.name),
            limits=Limits(**job["limits"]),
            mark_synthetic=job["mark_synthetic"],
            erased={local(one): one["erased"] for source in job["inputs"].values() for one in erased_in(source)},
        ) as run:
            inputs = {name: local(source) for name, source in job["inputs"].items()}
            kind.work(inputs, kind.options.model_validate(job["options"]), out, run)
    except Canceled:
        return {"outcome": "canceled"}
    except InputError as error:
        return failed(error.code, error.detail, error.correctable, error.found)
    except Exception as error:
        traceback.print_exc()
        return _unexpected(error)
    return {"outcome": "succeeded"}


def failed(
    code: str, detail: str, correctable: tuple[str, ...] = (), found: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    return {"outcome": "failed", "code": code, "detail": detail, "correctable": list(correctable), "found": found or {}}


def local(source: Any) -> Any:
    """The path of an input, where nothing is if it was erased, a tuple of paths, or the candidates that the work chooses from."""
    if isinstance(source, list):
        return tuple(local(one) for one in source)
    if isinstance(source, dict) and "candidates" in source:
        return Candidates({name: local(one) for name, one in source["candidates"].items()})
    if isinstance(source, dict) and "erased" in source:
        return Path("erased") / source["erased"]
    return built_in.item(source["library"], source["name"]) if isinstance(source, dict) else Path(source)


def erased_in(source: Any) -> list[dict[str, str]]:
    """Those files of an input that were erased, which are known by what was in them."""
    return [
        one for one in (source if isinstance(source, list) else [source]) if isinstance(one, dict) and "erased" in one
    ]


def files_of(given: Given) -> tuple[Path, ...]:
    """All files that an input may be read from."""
    if isinstance(given, Candidates):
        return tuple(given.files.values())
    return given if isinstance(given, tuple) else (given,)


def _readable(descriptor: int) -> Callable[[], bool]:
    return lambda: bool(select.select([descriptor], [], [], 0)[0])


def _unexpected(error: BaseException) -> dict[str, Any]:
    """What went wrong that is no `InputError`: a limit where it can be told, otherwise a bug."""
    link: BaseException | None = error
    while link is not None:
        if isinstance(link, MemoryError) or getattr(link, "code", None) == -4:  # OpenCV's StsNoMem
            return failed("out_of_memory", "The job needs more memory than a job may use: send a smaller input.")
        if isinstance(link, IncompleteInstallation):
            return failed("installation_incomplete", f"The worker is not whole. {link.detail}")
        number = getattr(link, "errno", None)
        if number in (ENOSPC, EDQUOT):
            return failed("disk_full", "The disk became full during the job: free space and submit it again.")
        if number == EFBIG:
            return failed("file_limit", "The job writes a larger file than a job may write: ask for a smaller result.")
        if isinstance(link, OSError) and number in (EPERM, EACCES):
            return failed("not_permitted", "The job tried what no job may do; the worker's log says what.")
        link = link.__cause__ or link.__context__
    return failed("internal_error", "The job met a fault of the program; the worker's log says which.")
