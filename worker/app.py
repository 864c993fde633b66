"""The Celery application of a worker: one task, which is a hint that a job waits."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import structlog
from celery import signals
from celery.platforms import SecurityWarning
from sqlalchemy.exc import SQLAlchemyError

from service.context import Context
from service.database.sessions import database_unavailable
from service.job_records import jobs as repository
from service.jobs import fair_queue
from service.jobs.leases import Lease
from service.pulse import BEAT_SECONDS, Pulse, worker_name
from service.queue import TASK_NAME, queue_name
from service.storage.files import StorageUnavailable
from service.tables.jobs import Job
from service.traces.current import origin_logged
from worker.attempts.attempt import Attempt
from worker.attempts.spans import AttemptSpans
from worker.compilation.readiness import Readiness
from worker.job_process.children import Child, WarmChildren
from worker.periodic.housekeeping import keep_house
from worker.periodic.sweep import sweep
from worker.periodic.webhook_sender import WebhookSender
from worker.sandbox.privileges import user_id
from worker.short_lane import ShortLane

WEBHOOK_SECONDS = 0.5
"""How often is looked for webhooks that are due."""

REDIS_POLL_SECONDS = 0.2
"""How often is looked whether Redis answers again."""

MAX_FAREWELL_SECONDS = 5.0
"""Seconds in which running jobs are given back; then the worker ends, come what may."""

signals.worker_shutting_down.lock = threading.RLock()
# Celery tells of its end from a signal handler, under this lock. Signals may come one upon another, as when the service is killed: the
# second interrupts the first where it holds the lock, and would wait for it for good.


class Worker:
    """Runs jobs until it is told to stop. The threads of Celery's pool watch over the processes that work."""

    def __init__(self, context: Context):
        self.context = context
        self.stopping = threading.Event()
        self.interrupted = False
        self._told = False
        self.user = user_id(context.settings.job_user)
        self.children: WarmChildren
        self.readiness: Readiness
        self.lane: ShortLane | None = None
        self.sender = WebhookSender(context)
        self.owner = worker_name(socket.gethostname(), os.getpid())
        self.pulse = Pulse(context.settings.data_dir, self.owner)
        context.queue.celery.task(name=TASK_NAME)(self.run_job)

    def run_job(self, job_id: str, kind: str) -> None:
        """Run the job of this kind whose turn it is: mostly not the one that the message tells of. The message may be
        late, or come twice: then there may be none."""
        if not self.stopping.is_set():
            self._run_next(kind, self.children)
        # Celery acknowledges the message now. Where that fails, it counts the message as under way for good, and once
        # all slots are full of such it listens no more, not even for the end of its connection.
        while not self.context.queue.reachable() and not self.stopping.wait(REDIS_POLL_SECONDS):
            pass

    def _run_next(self, kind: str, children: WarmChildren) -> None:
        """Run the job of this kind whose turn it is, if there is one, in one of these processes."""
        if kind not in self.readiness.ready:
            return
        child = children.take()  # before the lease, which would run while a process starts
        reuse = True
        try:
            if (claimed := self._claim(kind)) is not None:
                reuse = False
                reuse = self._attempt(*claimed, child)
        finally:
            children.give_back(child, reuse)

    def _attempt(self, job: Job, lease: Lease, child: Child) -> bool:
        """Attempt a job; all that is logged meanwhile names it. Returns whether the process may be used again."""
        spans = AttemptSpans(self.context.traces.tracer, job, lease)
        with origin_logged(job.request, spans.trace_id, job=job.id, kind=job.kind, attempt=lease.token):
            return Attempt(self.context, job, lease, child, self.stopping, spans, self.user).run()

    def _claim(self, kind: str) -> tuple[Job, Lease] | None:
        try:
            with self.context.database.write() as session:
                lease = fair_queue.claim_next(session, kind, self.owner, self.context.settings.lease_seconds)
                job = repository.get(session, lease.job_id) if lease is not None else None
        except SQLAlchemyError as error:
            structlog.get_logger().warning("job_not_claimed", reason=str(error).splitlines()[0])
            return None  # the sweep sends another message
        return (job, lease) if lease is not None and job is not None else None

    def run(self) -> None:
        """Work until SIGTERM or SIGINT; running jobs are given back to the queue then. Raises `KeyboardInterrupt` at the
        end of it where it was SIGINT, so that whoever started the worker sees by what it ended."""
        signals.worker_shutting_down.connect(self._stop, weak=False)
        signals.setup_logging.connect(_leave_logging_alone, weak=False)
        # Running as root is the operator's choice; what is warned of (pickled messages) is not accepted here.
        warnings.simplefilter("ignore", SecurityWarning)
        self.pulse.beat()
        for task in (self._beat, self._sweep, self._keep_house, self._deliver_webhooks):
            threading.Thread(target=task, name=task.__name__, daemon=True).start()
        kinds = self.context.settings.worker_kinds or list(self.context.kinds)
        for number in (signal.SIGTERM, signal.SIGINT):  # Celery listens only later
            signal.signal(number, self._quit)
        self.readiness = Readiness(self.context, kinds)
        self.readiness.await_one()
        settings = self.context.settings
        self.children = WarmChildren(settings, settings.concurrency, settings.worker_kinds, self.user)
        self.lane = self._short_lane(kinds)
        queues = [queue_name(kind) for kind in self.readiness.ready]
        structlog.get_logger().info("worker_started", kinds=kinds, owner=self.owner)
        worker = self.context.queue.celery.Worker(
            queues=queues, without_gossip=True, without_mingle=True, without_heartbeat=True, quiet=True
        )
        self.readiness.rehearse_others(partial(self._begin, worker.consumer))
        worker.start()
        self._stop()
        if self.lane is not None:
            self.lane.close(MAX_FAREWELL_SECONDS)
        self.children.close()
        if self.interrupted:
            raise KeyboardInterrupt

    def _short_lane(self, kinds: Sequence[str]) -> ShortLane | None:
        """The lane for the short ones of these kinds; None where there are none, or nothing else that could hold them up."""
        short = [kind for kind in kinds if self.context.kinds[kind].needs.short]
        places = self.context.settings.short_concurrency
        if not short or len(short) == len(kinds) or not places:
            return None
        children = WarmChildren(self.context.settings, places, short, self.user)
        return ShortLane(self.context, short, places, children, self._run_next, self._repeat)

    def _begin(self, consumer: Any, kind: str) -> None:
        """Take the jobs of a kind from now on. The queue is chosen at once, so that a connection that is made anew listens
        to it, too; this one begins once its loop runs."""
        self.children.renew()
        if self.lane is not None:
            self.lane.children.renew()
        structlog.get_logger().info("kind_began", kind=kind)
        queues = self.context.queue.celery.amqp.queues
        queues.select_add(queues[queue_name(kind)])
        consumer.call_soon(consumer.add_task_queue, queue_name(kind))

    def _quit(self, number: int, *_: Any) -> None:
        self._stop(sig=signal.Signals(number).name)
        if self.interrupted:
            raise KeyboardInterrupt
        sys.exit()

    def _stop(self, sig: str = "", **_: Any) -> None:
        """`sig` is the name of the signal that it was told by, as Celery says it."""
        if not self._told:
            self._told = (
                True  # first of all: another signal may interrupt what follows, whose locks are not to be taken twice
            )
            self.interrupted = sig == signal.SIGINT.name
            self.stopping.set()
            # Celery waits for a Redis that may be gone already. Nothing is lost by not waiting with it.
            last = threading.Timer(MAX_FAREWELL_SECONDS, os._exit, [128 + signal.SIGINT if self.interrupted else 0])
            last.daemon = True
            last.start()

    def _beat(self) -> None:
        self._repeat(self.pulse.beat, BEAT_SECONDS)
        self.pulse.end()

    def _sweep(self) -> None:
        self._repeat(lambda: sweep(self.context), self.context.settings.sweep_seconds)

    def _keep_house(self) -> None:
        self._repeat(lambda: keep_house(self.context), self.context.settings.sweep_seconds * 12)

    def _deliver_webhooks(self) -> None:
        self._repeat(self.sender.look, WEBHOOK_SECONDS)
        self.sender.close()

    def _repeat(self, task: Callable[[], object], seconds: float) -> None:
        """Do something again and again until the worker stops, whatever becomes of it."""
        log = structlog.get_logger().bind(task=threading.current_thread().name)
        while not self.stopping.wait(seconds):
            try:
                task()
            except Exception as error:
                if isinstance(error, StorageUnavailable) or database_unavailable(error):
                    log.warning("task_put_off", reason=str(error).splitlines()[0])
                else:
                    log.exception("task_failed")


def _leave_logging_alone(**_: Any) -> None:
    """Celery sets up its own logging unless somebody answers its signal."""


def run(context: Context) -> None:
    """Run a worker until it is told to stop, then close what it worked with."""
    try:
        Worker(context).run()
    finally:
        context.close()
