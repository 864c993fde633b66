"""One attempt at a job: a process does the work, this watches over it and keeps SQL true.

Every few tenths of a second it passes on progress, renews the lease, and looks whether the lease still stands,
whether limits are kept, whether the worker is to stop. Losing the lease is the one way in which cancellation,
deletion and a take-over by another worker show; the process is then told to stop, and is killed if it does not.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from dataclasses import asdict
from errno import EDQUOT, ENOSPC
from pathlib import Path
from threading import Event
from typing import Any

import structlog
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from service.context import Context
from service.disk import free_mb
from service.jobs import leases, repository
from service.jobs.leases import Lease
from service.jobs.models import Job, Status
from worker.children import Child, ChildLost
from worker.eta import Eta
from worker.publish import Refused, publish, publish_all

TICK_SECONDS = 0.1
LOOK_SECONDS = 0.4
REPORT_SECONDS = 0.4
GRACE_SECONDS = 1.0
"""How long a process may take to stop by itself."""

RESERVE_FOR_JOBS = 0.5
"""A job may eat into the disk reserve down to this part of it: the rest keeps the database writable."""

DISK_FULL = "The disk became full during the job: free space and submit it again."


class Stop(Exception):
    """The attempt ends from outside: `verdict` says how (see `_conclude`)."""

    def __init__(self, verdict: dict[str, Any]):
        super().__init__(verdict)
        self.verdict = verdict


class Attempt:
    """Runs one job in one process, under one lease."""

    def __init__(self, context: Context, job: Job, lease: Lease, child: Child, stopping: Event):
        self._context = context
        self._job = job
        self._lease = lease
        self._child = child
        self._stopping = stopping
        self._folder = context.settings.job_folder(job.id) / f"attempt-{lease.token}"
        self._out = self._folder / "out"
        self._started = self._renewed = self._looked = self._reported = time.monotonic()
        self._eta = Eta()
        self._progress: dict[str, Any] | None = None
        self._published: dict[str, tuple[int, int]] = {}

    def run(self) -> bool:
        """Work until the job ends one way or another. Returns whether the process may be used again."""
        log = structlog.get_logger().bind(job=self._job.id, kind=self._job.kind, attempt=self._lease.token)
        log.info("attempt_started")
        try:
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
        clean = verdict.get("clean") is True
        if not clean:
            tail = self._child.log_tail()
            self._child.kill()
            if verdict.get("code") == "internal_error" or verdict["outcome"] == "crashed":
                log.error("attempt_broke", verdict=verdict, printed=tail)
        try:
            verdict = self._conclude(verdict)
        finally:
            shutil.rmtree(self._folder, ignore_errors=True)
        log.info("attempt_ended", outcome=verdict["outcome"], code=verdict.get("code"))
        return clean

    def _prepare(self) -> None:
        stages = self._context.settings.job_folder(self._job.id) / "stages"
        temporary = self._folder / "temporary"
        for folder in (self._out, temporary, stages):
            folder.mkdir(parents=True, exist_ok=True)
        for draft in stages.glob(".draft-*"):  # left by a process that was killed
            shutil.rmtree(draft, ignore_errors=True)
        self._child.send(
            {
                "command": "work",
                "kind": self._job.kind,
                "inputs": {name: self._local(source) for name, source in self._job.sources.items()},
                "options": self._job.options,
                "out": str(self._out),
                "temporary": str(temporary),
                "stages": str(stages),
                "shared": str(self._context.settings.data_dir / "cache"),
                "limits": asdict(self._context.settings.limits),
            }
        )

    def _local(self, source: Any) -> Any:
        if isinstance(source, list):
            return [self._local(one) for one in source]
        return str(self._context.storage.local(f"files/{source['file']}")) if "file" in source else source

    def _watch(self) -> dict[str, Any]:
        while True:
            for event in self._child.receive(TICK_SECONDS):
                if event["event"] == "end":
                    return event
                self._note(event)
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
                stage, fraction = str(event["stage"])[:100], min(max(float(event["fraction"]), 0.0), 1.0)
                eta = self._eta.after(fraction)
                message = str(event["message"])[:500]
                changed = self._progress is None or self._progress["stage"] != stage
                self._progress = {"stage": stage, "fraction": fraction, "message": message, "eta_seconds": eta}
                if changed and time.monotonic() - self._reported > TICK_SECONDS:
                    self._report()
            case "stored":
                self._write(lambda session: leases.bear_fruit(session, self._lease))
            case "artifact":
                self._publish(self._out / Path(str(event["name"])).name)

    def _report(self) -> None:
        progress, self._progress = self._progress, None
        self._reported = time.monotonic()
        if progress is not None:
            self._write(lambda session: leases.report(session, self._lease, progress))

    def _publish(self, path: Path) -> None:
        try:
            published = publish(self._context, self._lease, path)
        except Refused as refused:
            structlog.get_logger().warning("artifact_refused", job=self._job.id, reason=str(refused))
            return
        if published is None:
            raise Stop({"outcome": "lost"})
        self._published[path.name] = published

    def _write(self, change: Callable[[Session], bool]) -> None:
        """Change the job in SQL. A database that cannot be written for a while (a full disk, a lock) is borne as long
        as the lease lasts."""
        try:
            with self._context.database.write() as session:
                held = change(session)
        except SQLAlchemyError as error:
            structlog.get_logger().warning("database_not_written", job=self._job.id, reason=str(error))
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
                published = publish_all(self._context, self._lease, self._out, self._published)
                return verdict if published else {"outcome": "lost"}
            except Refused as refused:
                verdict = {"outcome": "failed", "code": "internal_error", "detail": str(refused)}
            except OSError as error:
                verdict = _unwritten(error)
        shutil.rmtree(self._folder, ignore_errors=True)  # first, so that a full disk has room for the record
        end = {"failed": self._fail, "crashed": self._give_back, "stopped": self._give_back}.get(verdict["outcome"])
        if end is not None:
            insist(lambda: end(verdict), self._lease.seconds)
        if not self._context.settings.job_folder(self._job.id).exists():
            return verdict
        with self._context.database.read() as session:
            if repository.get(session, self._job.id) is None:  # deleted while it ran
                shutil.rmtree(self._context.settings.job_folder(self._job.id), ignore_errors=True)
        return verdict

    def _fail(self, verdict: dict[str, Any]) -> None:
        with self._context.database.write() as session:
            correctable = [str(name) for name in verdict.get("correctable", ())]
            leases.fail(session, self._lease, str(verdict["code"]), str(verdict["detail"])[:2000], correctable)

    def _give_back(self, verdict: dict[str, Any]) -> None:
        with self._context.database.write() as session:
            counts = verdict["outcome"] == "crashed"
            status = leases.give_back(session, self._lease, verdict["reason"], counts)
        if status == Status.QUEUED:
            self._context.queue.send(self._job.id, self._job.kind)


def insist(change: Callable[[], None], seconds: float) -> None:
    """Change the job in SQL, trying again for a while where the database cannot be written (a full disk, a lock)."""
    deadline = time.monotonic() + seconds
    while True:
        try:
            change()
        except SQLAlchemyError as error:
            if time.monotonic() > deadline:
                raise
            structlog.get_logger().warning("database_not_written", reason=str(error))
            time.sleep(1)
        else:
            return


def _unwritten(error: OSError) -> dict[str, Any]:
    if error.errno in (ENOSPC, EDQUOT):
        return {"outcome": "failed", "code": "disk_full", "detail": DISK_FULL}
    return {"outcome": "failed", "code": "internal_error", "detail": f"The job's files cannot be written: {error}"}
