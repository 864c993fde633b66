"""One attempt at a job: a process does the work, this watches over it and keeps SQL true.

Every few tenths of a second it passes on progress, renews the lease, and looks whether the lease still stands,
whether limits are kept, whether the worker is to stop. Losing the lease is the one way in which cancellation,
deletion and a take-over by another worker show; the process is then told to stop, and is killed if it does not.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from pathlib import Path
from threading import Event
from typing import Any

import structlog
from opentelemetry.trace import Span
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from service.catalogue.allowance import Allowance
from service.context import Context
from service.disk import free_mb
from service.jobs import leases
from service.jobs.leases import Lease
from service.tables.jobs import Job
from service.traces.tracer import fail
from worker.attempts.conclusion import DISK_FULL, conclude, erase_unneeded, unwritten_verdict
from worker.attempts.eta import Eta
from worker.attempts.heartbeat import renewing_lease
from worker.attempts.preparation import Folders, prepare
from worker.attempts.spans import AttemptSpans
from worker.attempts.stage_order import Stages
from worker.job_files import inputs
from worker.job_files.fetch import FetchFailed
from worker.job_files.mirror import Mirror
from worker.job_files.plain_files import FileRefused
from worker.job_files.publish import publish
from worker.job_process.children import Child, ChildLost

TICK_SECONDS = 0.1
ATTEMPT_POLL_SECONDS = 0.4
REPORT_SECONDS = 0.4
STOPPED_SECONDS = 10.0
"""How long a process may stand still that a signal has stopped."""

GRACE_SECONDS = 1.0
"""How long a process may take to stop by itself."""

RESERVE_FOR_JOBS = 0.5
"""A job may eat into the disk reserve down to this part of it: the rest keeps the database writable."""

FETCHING_SHARE = 0.1
"""The part of a job's progress that fetching inputs counts for, where there are any to fetch."""

FAULT_CODES = ("internal_error", "not_permitted")
"""Codes of ends that the operator should hear of."""


class Stop(Exception):
    """The attempt ends from outside: `verdict` says how (see `worker.attempts.conclusion`)."""

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
        self._allowance = Allowance.of(context.kinds[job.kind], context.settings)
        self._job = job
        self._lease = lease
        self._child = child
        self._stopping = stopping
        self._spans = spans
        self._folders = Folders.of(context, job, lease)
        self._mirror = Mirror(context.storage, job.tree, self._folders.stages, self._folders.mirrored)
        self._started = self._renewed = self._looked = self._went_on = time.monotonic()
        self._reported = self._started - 1
        self._eta = Eta(cold=job.kind not in child.worked_on)
        child.worked_on.add(job.kind)
        self._progress: dict[str, Any] | None = None
        self._stage: str | None = None
        """The stage that was told of last."""
        self._stages = Stages(job.progress.get("stages", ()))
        self._working: float | None = None
        """Since when the process has been told what to do."""
        self._fetched = 0.0
        """The part of the progress that fetching took."""
        self._published: dict[str, tuple[int, int]] = {}

    def run(self) -> bool:
        """Work until the job ends one way or another. Returns whether the process may be used again."""
        log = structlog.get_logger()
        log.info("attempt_started")
        try:
            self._fetch_inputs()
            with renewing_lease(self._context, self._lease):
                told = prepare(self._context, self._job, self._folders, self._mirror, self._allowance, self._user)
            self._working = time.monotonic()
            self._child.send(told)
            verdict = self._watch()
        except Stop as stop:
            verdict = stop.verdict
        except FetchFailed as failed:
            verdict = {"outcome": "failed", "code": failed.code, "detail": failed.detail, "clean": True}
        except ChildLost as lost:
            verdict = {"outcome": "crashed", "reason": str(lost)}
        except OSError as error:
            verdict = unwritten_verdict(error)
        except Exception:
            log.exception("attempt_unwatched")
            verdict = {"outcome": "crashed", "reason": "the worker met a fault of the program"}
        if verdict.get("code") in FAULT_CODES or verdict["outcome"] == "crashed":
            log.error("attempt_broke", verdict=verdict, printed=self._child.log_tail())
        clean = verdict.get("clean") is True or self._child.end_job(GRACE_SECONDS)
        if not clean:
            self._child.kill()
        try:
            verdict = conclude(self._context, self._job, self._lease, verdict, self._folders, self._published)
        finally:
            self._spans.end(verdict)
            self._mirror.close(wait=verdict["outcome"] != "lost")
            for folder in (self._folders.attempt, self._folders.mirrored):
                shutil.rmtree(folder, ignore_errors=True)
            erase_unneeded(self._context, self._job)
        log.info("attempt_ended", outcome=verdict["outcome"], code=verdict.get("code"))
        return clean

    def _fetch_inputs(self) -> None:
        """Fetch the inputs that are addresses; those that an earlier attempt has fetched are files already."""
        urls = inputs.addresses(self._job.sources)
        folder = self._folders.fetched
        if urls:
            folder.mkdir(parents=True, exist_ok=True)
        for number, url in enumerate(urls):
            with self._spans.fetching(url) as span:
                self._fetch(url, folder, number, len(urls), span)
        self._fetched = FETCHING_SHARE if urls else 0.0

    def _fetch(self, url: str, folder: Path, number: int, count: int, span: Span) -> None:
        """Fetch one of `count` inputs and keep it as a file of the job. Raises `Stop`."""
        fetching, told, ended = inputs.RunningFetch(self._context, url, folder), "", False
        try:
            while not ended:
                ended = fetching.ended(TICK_SECONDS)
                if fetching.message != told:
                    told = fetching.message
                    self._tell("fetch", FETCHING_SHARE * (number + fetching.fraction) / count, told)
                self._tend()
            with renewing_lease(self._context, self._lease):
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

    def _watch(self) -> dict[str, Any]:
        while True:
            for event in self._child.receive(TICK_SECONDS):
                if event["event"] == "end":
                    self._report()
                    return event
                self._note(event)
            self._tend()

    def _tend(self) -> None:
        """See to limits, orders, progress and the lease. Raises `Stop`."""
        self._check_limits()
        moment = time.monotonic()
        if moment - self._looked > ATTEMPT_POLL_SECONDS:
            self._looked = moment
            self._check_orders()
            self._check_going_on(moment)
        if self._progress is not None and moment - self._reported > REPORT_SECONDS:
            self._report()
        elif moment - self._renewed > self._lease.seconds / 4:
            self._write(lambda session: leases.update_job(session, self._lease))

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
                self._write(lambda session: leases.note_new_stage(session, self._lease))
            case "artifact":
                self._publish(self._folders.out / Path(str(event["name"])).name)

    def _tell(self, stage: str, fraction: float, message: str) -> None:
        """Take note of progress, to be reported soon; the beginning of a stage at once."""
        eta = self._eta.after(fraction, stage)
        self._stages.begin(stage)
        changed, self._stage = stage != self._stage, stage
        self._progress = {"stage": stage, "fraction": fraction, "message": message, "eta_seconds": eta}
        if changed and time.monotonic() - self._reported > TICK_SECONDS:
            self._report()

    def _report(self) -> None:
        progress, self._progress = self._progress, None
        self._reported = time.monotonic()
        if progress is not None:
            begun = self._stages.news()
            self._write(
                lambda session: leases.report_progress(session, self._lease, progress, self._stages.names, begun)
            )

    def _publish(self, path: Path) -> None:
        try:
            with renewing_lease(self._context, self._lease):
                published = publish(self._context, self._lease, path)
        except FileRefused as refused:
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
        moment = time.monotonic()
        if self._child.memory_mb() > self._allowance.memory_mb:
            detail = "The job needs more memory than a job may use: send a smaller input."
            raise Stop({"outcome": "failed", "code": "out_of_memory", "detail": detail})
        working = moment - self._working if self._working is not None else 0.0
        if working > self._allowance.seconds or moment - self._started > settings.job_seconds:
            detail = self._allowance.too_long()
            raise Stop({"outcome": "failed", "code": "time_limit", "detail": detail})
        if free_mb(settings) < settings.disk_reserve_mb * RESERVE_FOR_JOBS:
            raise Stop({"outcome": "failed", "code": "disk_full", "detail": DISK_FULL})

    def _check_going_on(self, moment: float) -> None:
        """A process that somebody has stopped is waited for a while, and then replaced."""
        if not self._child.stopped():
            self._went_on = moment
        elif moment - self._went_on > STOPPED_SECONDS:
            raise Stop({"outcome": "crashed", "reason": "the job's process was stopped and did not go on"})

    def _check_orders(self) -> None:
        if self._stopping.is_set():
            raise Stop({"outcome": "stopped", "reason": "the worker was told to stop"})
        try:
            with self._context.database.read() as session:
                held = leases.is_held(session, self._lease)
        except SQLAlchemyError:
            return  # the heartbeat decides how long that may last
        if not held:
            raise Stop({"outcome": "lost", "clean": self._let_stop()})

    def _let_stop(self) -> bool:
        """Tell the process to stop and give it a moment to do so. Returns whether it did, and cleanly."""
        if self._working is None:
            return True
        self._child.send({"command": "cancel"})
        deadline = time.monotonic() + GRACE_SECONDS
        while time.monotonic() < deadline:
            for event in self._child.receive(TICK_SECONDS):
                if event["event"] == "end":
                    return event.get("clean") is True
        return False
