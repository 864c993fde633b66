"""The Celery application of a worker: one task, which is a hint that a job waits."""

from __future__ import annotations

import os
import socket
import threading
import warnings
from typing import Any

import structlog
from celery import signals
from celery.platforms import SecurityWarning

from service.context import Context
from service.jobs import leases, repository
from service.queue import TASK, queue_name
from service.settings import Settings
from worker.attempt import Attempt
from worker.children import WarmChildren
from worker.housekeeping import keep_house
from worker.sweep import sweep

LONGEST_FAREWELL = 5.0
"""Seconds in which running jobs are given back; then the worker ends, come what may."""


class Worker:
    """Runs jobs until it is told to stop. The threads of Celery's pool watch over the processes that work."""

    def __init__(self, context: Context):
        self.context = context
        self.stopping = threading.Event()
        self.children = WarmChildren(context.settings)
        self.owner = f"{socket.gethostname()}:{os.getpid()}"
        context.queue.celery.task(name=TASK)(self.run_job)

    def run_job(self, job_id: str) -> None:
        """Run a job if it still waits; the message may be late, or come twice."""
        if self.stopping.is_set():
            return
        with self.context.database.write() as session:
            lease = leases.claim(session, job_id, self.owner, self.context.settings.lease_seconds)
            job = repository.get(session, job_id) if lease is not None else None
        if lease is None or job is None:
            return
        reuse = False
        child = self.children.take()
        try:
            reuse = Attempt(self.context, job, lease, child, self.stopping).run()
        finally:
            self.children.give_back(child, reuse)

    def run(self) -> None:
        """Work until SIGTERM or SIGINT; running jobs are given back to the queue then."""
        signals.worker_shutting_down.connect(self._stop, weak=False)
        signals.setup_logging.connect(_leave_logging_alone, weak=False)
        # Running as root is the operator's choice; what is warned of (pickled messages) is not accepted here.
        warnings.simplefilter("ignore", SecurityWarning)
        for task in (self._sweep, self._keep_house):
            threading.Thread(target=task, name=task.__name__, daemon=True).start()
        queues = [queue_name(kind) for kind in self.context.kinds]
        structlog.get_logger().info("worker_started", kinds=list(self.context.kinds), owner=self.owner)
        worker = self.context.queue.celery.Worker(
            queues=queues, without_gossip=True, without_mingle=True, without_heartbeat=True, quiet=True
        )
        worker.start()
        self._stop()
        self.children.close()

    def _stop(self, *_: Any, **__: Any) -> None:
        if not self.stopping.is_set():
            self.stopping.set()
            # Celery waits for a Redis that may be gone already. Nothing is lost by not waiting with it.
            last = threading.Timer(LONGEST_FAREWELL, os._exit, [0])
            last.daemon = True
            last.start()

    def _sweep(self) -> None:
        while not self.stopping.wait(self.context.settings.sweep_seconds):
            try:
                sweep(self.context)
            except Exception:
                structlog.get_logger().exception("sweep_failed")

    def _keep_house(self) -> None:
        while not self.stopping.wait(self.context.settings.sweep_seconds * 12):
            try:
                keep_house(self.context)
            except Exception:
                structlog.get_logger().exception("housekeeping_failed")


def _leave_logging_alone(**_: Any) -> None:
    """Celery sets up its own logging unless somebody answers its signal."""


def run(settings: Settings) -> None:
    """Run a worker until it is told to stop."""
    context = Context.open(settings)
    try:
        Worker(context).run()
    finally:
        context.close()
