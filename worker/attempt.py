"""One attempt at a job: a process does the work, this watches over it and keeps SQL true.

Every few tenths of a second it passes on progress, renews the lease, and looks whether the lease still stands,
whether limits are kept, whether the worker is to stop. Losing the lease is the one way in which cancellation,
deletion and a take-over by another worker show; the process is then told to stop, and is killed if it does not.
"""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from errno import EDQUOT, ENOSPC
from pathlib import Path
from threading import Event
from typing import Any

import structlog
from opentelemetry.trace import Span
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from engine.store import StageStore
from service.context import Context
from service.disk import free_mb
from service.files import analyses
from service.files import repository as files
from service.jobs import leases, repository
from service.jobs.leases import Lease
from service.jobs.models import Job, Status
from service.jobs.stages import erase
from service.storage import StorageUnavailable
from service.traces.tracer import fail
from worker import inputs
from worker.children import Child, ChildLost
from worker.eta import Eta
from worker.fetch import FetchFailed
from worker.heartbeat import beating
from worker.insist import insist
from worker.mirror import Mirror
from worker.plain_files import Refused
from worker.publish import publish, publish_all
from worker.spans import AttemptSpans

TICK_SECONDS = 0.1
LOOK_SECONDS = 0.4
REPORT_SECONDS = 0.4
MOST_FOUND = 20_000
"""Characters of what a failed job may say it has found."""
GRACE_SECONDS = 1.0
"""How long a process may take to stop by itself."""

RESERVE_FOR_JOBS = 0.5
"""A job may eat into the disk reserve down to this part of it: the rest keeps the database writable."""

FETCHING = 0.1
"""The part of a job's progress that fetching inputs counts for, where there are any to fetch."""

FAULTS = ("internal_error", "not_permitted")
"""Codes of ends that the operator should hear of."""

DISK_FULL = "The disk became full during the job: free space and submit it again."


class Stop(Exception):
    """The attempt ends from outside: `verdict` says how (see `_conclude`)."""

    def __init__(self, verdict: dict[str, Any]):
        super().__init__(verdict)
        self.verdict = verdict


class Attempt:
    """Runs one job in one process, under one lease."""

    def __init__(
        self,
        context: Context,
        job: Job,
        lease: Lease,
        child: Child,
        stopping: Event,
        spans: AttemptSpans,
        user: int | None = None,
    ):
        """`user` is who the process works as, None for the worker's own."""
        self._user = user
        self._context = context
        self._job = job
        self._lease = lease
        self._child = child
        self._stopping = stopping
        self._spans = spans
        self._folder = context.settings.job_folder(job.id) / f"attempt-{lease.token}"
        self._out = self._folder / "out"
        self._stages = context.settings.job_folder(job.tree) / "stages"
        self._mirrored = context.settings.job_folder(job.id) / f"mirror-{lease.token}"
        self._mirror = Mirror(context.storage, job.tree, self._stages, self._mirrored)
        self._started = self._renewed = self._looked = time.monotonic()
        self._reported = self._started - 1
        self._eta = Eta()
        self._progress: dict[str, Any] | None = None
        self._stage: str | None = None
        """The stage that was told of last."""
        self._working = False
        """Whether the process has been told what to do."""
        self._fetched = 0.0
        """The part of the progress that fetching took."""
        self._published: dict[str, tuple[int, int]] = {}

    def run(self) -> bool:
        """Work until the job ends one way or another. Returns whether the process may be used again."""
        log = structlog.get_logger()
        log.info("attempt_started")
        try:
            self._fetch_inputs()
            self._prepare()
            verdict = self._watch()
        except Stop as stop:
            verdict = stop.verdict
        except ChildLost as lost:
            verdict = {"outcome": "crashed", "reason": str(lost)}
        except OSError as error:
            verdict = _unwritten(error)
        except Exception:
            log.exception("attempt_unwatched")
            verdict = {"outcome": "crashed", "reason": "the worker met a fault of the program"}
        if verdict.get("code") in FAULTS or verdict["outcome"] == "crashed":
            log.error("attempt_broke", verdict=verdict, printed=self._child.log_tail())
        clean = verdict.get("clean") is True or self._child.end_job(GRACE_SECONDS)
        if not clean:
            self._child.kill()
        try:
            verdict = self._conclude(verdict)
        finally:
            self._spans.end(verdict)
            self._mirror.close(wait=verdict["outcome"] != "lost")
            for folder in (self._folder, self._mirrored):
                shutil.rmtree(folder, ignore_errors=True)
            self._erase_unneeded()
        log.info("attempt_ended", outcome=verdict["outcome"], code=verdict.get("code"))
        return clean

    def _fetch_inputs(self) -> None:
        """Fetch the inputs that are addresses; those that an earlier attempt has fetched are files already."""
        urls = inputs.addresses(self._job.sources)
        folder = self._folder / "fetched"
        if urls:
            folder.mkdir(parents=True, exist_ok=True)
        for number, url in enumerate(urls):
            with self._spans.fetching(url) as span:
                self._fetch(url, folder, number, len(urls), span)
        self._fetched = FETCHING if urls else 0.0

    def _fetch(self, url: str, folder: Path, number: int, count: int, span: Span) -> None:
        """Fetch one of `count` inputs and keep it as a file of the job. Raises `Stop`."""
        fetching, told, ended = inputs.Fetching(self._context, url, folder), "", False
        try:
            while not ended:
                ended = fetching.ended(TICK_SECONDS)
                if fetching.message != told:
                    told = fetching.message
                    self._tell("fetch", FETCHING * (number + fetching.fraction) / count, told)
                self._tend()
            with beating(self._context, self._lease):
                sources = inputs.keep(self._context, self._job, self._lease, url, fetching.result())
        except FetchFailed as failed:
            fail(span, failed.code)
            verdict = {"outcome": "failed", "code": failed.code, "detail": failed.detail, "clean": True}
            raise Stop(verdict) from failed
        except SQLAlchemyError:
            sources = None
        finally:
            fetching.stop()
        if sources is None:
            raise Stop({"outcome": "lost", "clean": True})
        self._job.sources = sources

    def _prepare(self) -> None:
        stages, temporary, copies = self._stages, self._folder / "temporary", self._folder / "inputs"
        for folder in self._folder.parent.glob("*-*"):  # what an attempt left whose worker was killed
            shutil.rmtree(folder, ignore_errors=True)
        for folder in (self._out, temporary, copies, self._mirrored, stages):
            folder.mkdir(parents=True, exist_ok=True)
        StageStore(stages).discard_drafts()
        os.utime(stages.parent)  # housekeeping sees that it is in use
        with beating(self._context, self._lease):
            self._mirror.restore()
            local = {name: self._local(source, copies) for name, source in self._job.sources.items()}
        shared = self._shared() or stages
        shared.mkdir(parents=True, exist_ok=True)
        if self._user is not None:
            hand_over((self._out, temporary, stages, shared), self._user)
        self._working = True
        self._child.send(
            {
                "command": "work",
                "kind": self._job.kind,
                "inputs": local,
                "options": self._job.options,
                "out": str(self._out),
                "temporary": str(temporary),
                "stages": str(stages),
                "shared": str(shared),
                "mark_synthetic": self._context.settings.mark_synthetic,
                "limits": asdict(self._context.settings.limits),
            }
        )

    def _shared(self) -> Path | None:
        """Where analyses lie that serve other jobs with the same input too."""
        kind = self._context.kinds[self._job.kind]
        name = next((one.name for one in kind.inputs if one.serves_many and not one.many), None)
        source = self._job.sources.get(name) if name is not None else None
        if source is None or "candidates" in source:  # whose analyses are kept with the job
            return None
        if "library" in source:
            return analyses.folder(self._context.settings, analyses.LIBRARY, source["name"])
        with self._context.database.read() as session:
            file = files.get(session, self._job.owner, source["file"])
        return analyses.folder(self._context.settings, file.owner, file.sha256) if file is not None else None

    def _local(self, source: Any, folder: Path) -> Any:
        """A source as the process takes it: the path of a file, fetched into the folder where it lies elsewhere."""
        if isinstance(source, list):
            return [self._local(one, folder) for one in source]
        if "candidates" in source:
            return {"candidates": {name: self._local(one, folder) for name, one in source["candidates"].items()}}
        if "file" not in source:
            return source
        return str(self._context.storage.fetch(f"files/{source['file']}", folder / source["file"]))

    def _watch(self) -> dict[str, Any]:
        while True:
            for event in self._child.receive(TICK_SECONDS):
                if event["event"] == "end":
                    return event
                self._note(event)
            self._tend()

    def _tend(self) -> None:
        """See to limits, orders, progress and the lease. Raises `Stop`."""
        self._check_limits()
        moment = time.monotonic()
        if moment - self._looked > LOOK_SECONDS:
            self._looked = moment
            self._check_orders()
        if self._progress is not None and moment - self._reported > REPORT_SECONDS:
            self._report()
        elif moment - self._renewed > self._lease.seconds / 4:
            self._write(lambda session: leases.change(session, self._lease))

    def _note(self, event: dict[str, Any]) -> None:
        match event["event"]:
            case "progress":
                fraction = min(max(float(event["fraction"]), 0.0), 1.0)
                fraction = self._fetched + (1 - self._fetched) * fraction
                self._tell(str(event["stage"])[:100], fraction, str(event["message"])[:500])
            case "stage":
                self._spans.stage(event)
            case "stored":
                self._mirror.keep(str(event.get("key")))
                self._write(lambda session: leases.bear_fruit(session, self._lease))
            case "artifact":
                self._publish(self._out / Path(str(event["name"])).name)

    def _tell(self, stage: str, fraction: float, message: str) -> None:
        """Take note of progress, to be reported soon; the beginning of a stage at once."""
        eta = self._eta.after(fraction)
        changed, self._stage = stage != self._stage, stage
        self._progress = {"stage": stage, "fraction": fraction, "message": message, "eta_seconds": eta}
        if changed and time.monotonic() - self._reported > TICK_SECONDS:
            self._report()

    def _report(self) -> None:
        progress, self._progress = self._progress, None
        self._reported = time.monotonic()
        if progress is not None:
            self._write(lambda session: leases.report(session, self._lease, progress))

    def _publish(self, path: Path) -> None:
        try:
            with beating(self._context, self._lease):
                published = publish(self._context, self._lease, path)
        except Refused as refused:
            structlog.get_logger().warning("artifact_refused", reason=str(refused))
            return
        except SQLAlchemyError:
            published = None
        if published is None:
            raise Stop({"outcome": "lost"})
        self._renewed = time.monotonic()
        self._published[path.name] = published

    def _write(self, change: Callable[[Session], bool]) -> None:
        """Change the job in SQL. A database that cannot be written for a while (a full disk, a lock) is borne as long
        as the lease lasts."""
        try:
            with self._context.database.write() as session:
                held = change(session)
        except SQLAlchemyError as error:
            structlog.get_logger().warning("database_not_written", reason=str(error))
            if time.monotonic() - self._renewed < self._lease.seconds:
                return
            held = False
        if not held:
            raise Stop({"outcome": "lost"})
        self._renewed = time.monotonic()

    def _check_limits(self) -> None:
        settings = self._context.settings
        seconds = time.monotonic() - self._started
        if self._child.memory_mb() > settings.job_memory_mb:
            detail = "The job needs more memory than a job may use: send a smaller input."
            raise Stop({"outcome": "failed", "code": "out_of_memory", "detail": detail})
        if seconds > settings.job_seconds:
            detail = f"The job took longer than {settings.job_seconds:g} seconds: send a shorter input."
            raise Stop({"outcome": "failed", "code": "time_limit", "detail": detail})
        if free_mb(settings) < settings.disk_reserve_mb * RESERVE_FOR_JOBS:
            raise Stop({"outcome": "failed", "code": "disk_full", "detail": DISK_FULL})

    def _check_orders(self) -> None:
        if self._stopping.is_set():
            raise Stop({"outcome": "stopped", "reason": "the worker was told to stop"})
        try:
            with self._context.database.read() as session:
                held = leases.holds(session, self._lease)
        except SQLAlchemyError:
            return  # the heartbeat decides how long that may last
        if not held:
            raise Stop({"outcome": "lost", "clean": self._let_stop()})

    def _let_stop(self) -> bool:
        """Tell the process to stop and give it a moment to do so. Returns whether it did, and cleanly."""
        if not self._working:
            return True
        self._child.send({"command": "cancel"})
        deadline = time.monotonic() + GRACE_SECONDS
        while time.monotonic() < deadline:
            for event in self._child.receive(TICK_SECONDS):
                if event["event"] == "end":
                    return event.get("clean") is True
        return False

    def _conclude(self, verdict: dict[str, Any]) -> dict[str, Any]:
        """Make the attempt's end true in SQL."""
        if verdict["outcome"] == "succeeded":
            try:
                with beating(self._context, self._lease):
                    published = publish_all(self._context, self._lease, self._out, self._published)
                return verdict if published else {"outcome": "lost"}
            except Refused as refused:
                verdict = {"outcome": "failed", "code": "internal_error", "detail": str(refused)}
            except OSError as error:
                verdict = _unwritten(error)
            except SQLAlchemyError:
                verdict = {"outcome": "lost"}
        shutil.rmtree(self._folder, ignore_errors=True)  # first, so that a full disk has room for the record
        end = {"failed": self._fail, "crashed": self._give_back, "stopped": self._give_back}.get(verdict["outcome"])
        try:
            if end is not None:
                insist(lambda: end(verdict), self._lease.seconds)
        except SQLAlchemyError:
            verdict = {"outcome": "lost"}  # the lease has ended meanwhile, and the job is another worker's
        return verdict

    def _erase_unneeded(self) -> None:
        """Erase what is left of a job that was deleted while it ran."""
        both = [self._job.id, self._job.tree]
        try:
            with self._context.database.read() as session:
                unneeded = set(both) - repository.with_folder(session, both)
        except SQLAlchemyError:
            return  # cut off: housekeeping does it
        for one in unneeded:
            erase(self._context, one)

    def _fail(self, verdict: dict[str, Any]) -> None:
        with self._context.database.write() as session:
            correctable = [str(name) for name in verdict.get("correctable", ())]
            found = verdict.get("found") or {}
            if len(json.dumps(found)) > MOST_FOUND:
                found = {}
            leases.fail(session, self._lease, str(verdict["code"]), str(verdict["detail"])[:2000], correctable, found)

    def _give_back(self, verdict: dict[str, Any]) -> None:
        with self._context.database.write() as session:
            counts = verdict["outcome"] == "crashed"
            status = leases.give_back(session, self._lease, verdict["reason"], counts)
        if status == Status.QUEUED:
            self._context.queue.send(self._job.id, self._job.kind)


def hand_over(folders: Sequence[Path], user: int) -> None:
    """Let a user change these folders and what lies directly in them. Only for folders that this user alone changes."""
    for folder in folders:
        for path in (folder, *folder.iterdir()):
            os.chown(path, user, user, follow_symlinks=False)


def _unwritten(error: OSError) -> dict[str, Any]:
    if isinstance(error, StorageUnavailable):
        return {"outcome": "stopped", "reason": "the storage did not answer"}
    if error.errno in (ENOSPC, EDQUOT):
        return {"outcome": "failed", "code": "disk_full", "detail": DISK_FULL}
    return {"outcome": "failed", "code": "internal_error", "detail": f"The job's files cannot be written: {error}"}
