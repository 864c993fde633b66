"""The sweep: jobs that waited in vain get another message, jobs whose worker fell silent get another attempt.

Any number of workers may sweep at once: every change is guarded, and a message too many does no harm.
"""

from __future__ import annotations

import redis
import structlog

from service.context import Context
from service.job_records import jobs as repository
from service.jobs import leases
from service.tables.jobs import Status

REQUEUE_SECONDS = 10.0
"""Seconds: how long a message may be on its way before it can count as lost."""


def sweep(context: Context) -> None:
    """Look once for both."""
    take_back_expired(context)
    send_lost(context)


def take_back_expired(context: Context) -> None:
    """Queue the running jobs whose lease has expired again; fail those that got nowhere three times in a row."""
    with context.database.read() as session:
        expired = leases.expired(session)
    for kind, lease in expired:
        with context.database.write() as session:
            status = leases.give_back(session, lease, "its worker fell silent", only_expired=True)
        if status is None:
            continue  # it spoke again, or another sweep was faster
        structlog.get_logger().warning("lease_expired", job=lease.job_id, now=status)
        if status == Status.QUEUED:
            context.queue.send(lease.job_id, kind)


def send_lost(context: Context) -> None:
    """Send another message for queued jobs where there are fewer messages than jobs: some were lost.

    Without that comparison, every look at a long queue would make it longer.
    """
    for kind in context.kinds:
        with context.database.read() as session:
            queued = repository.count_queued(session, kind)
            overdue = repository.queued(session, kind, REQUEUE_SECONDS)
        try:
            if not overdue or context.queue.waiting(kind) >= queued:
                continue
        except redis.RedisError:
            continue  # nothing can be sent either
        structlog.get_logger().warning("messages_lost", kind=kind, jobs=len(overdue))
        for job in overdue:
            if context.queue.send(job.id, kind):
                with context.database.write() as session:
                    repository.mark_enqueued(session, job.id)
