"""The course of a job, as workers change it: claimed by a lease, renewed by a heartbeat, fenced by a token.

Each function is one guarded UPDATE and returns whether it still applied. A worker whose lease was lost (the
job was canceled or erased, or another worker took over) can change nothing any more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

from sqlalchemy import case, select, update
from sqlalchemy.orm import Session

from service.clock import now
from service.events import repository as events
from service.jobs.models import Job, Status

MOST_FRUITLESS_ATTEMPTS = 3


@dataclass(frozen=True)
class Lease:
    """The right to work on a job."""

    job_id: str
    token: int
    seconds: float


def claim(session: Session, job_id: str, owner: str, seconds: float) -> Lease | None:
    """Take a queued job; None if it is not queued (any more), so that a message delivered twice runs once."""
    moment = now()
    taken = session.execute(
        update(Job)
        .where(Job.id == job_id, Job.status == Status.QUEUED)
        .values(
            status=Status.RUNNING,
            started_at=case((Job.started_at.is_(None), moment), else_=Job.started_at),
            lease_owner=owner,
            lease_token=Job.lease_token + 1,
            lease_expires_at=moment + timedelta(seconds=seconds),
            attempts=Job.attempts + 1,
            fruitless_attempts=Job.fruitless_attempts + 1,
        )
    )
    if taken.rowcount == 0:  # type: ignore[attr-defined]
        return None
    token = session.scalar(select(Job.lease_token).where(Job.id == job_id))
    events.append(session, job_id, "status", {"status": Status.RUNNING})
    return Lease(job_id, int(token or 0), seconds)


def holds(session: Session, lease: Lease) -> bool:
    """Whether the lease still stands; reads only."""
    query = select(Job.id).where(Job.id == lease.job_id, Job.lease_token == lease.token, Job.status == Status.RUNNING)
    return session.scalar(query) is not None


def change(session: Session, lease: Lease, **values: Any) -> bool:
    """Change columns of the job if the lease still stands, and renew the lease."""
    values.setdefault("lease_expires_at", now() + timedelta(seconds=lease.seconds))
    changed = session.execute(
        update(Job)
        .where(Job.id == lease.job_id, Job.lease_token == lease.token, Job.status == Status.RUNNING)
        .values(**values)
    )
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def report(session: Session, lease: Lease, progress: dict[str, Any]) -> bool:
    """Record progress."""
    if not change(session, lease, progress=progress, progress_at=now()):
        return False
    events.append(session, lease.job_id, "progress", progress)
    return True


def bear_fruit(session: Session, lease: Lease) -> bool:
    """Record that a new stage was stored: this attempt was not in vain."""
    return change(session, lease, fruitless_attempts=0)


def succeed(session: Session, lease: Lease) -> bool:
    progress = {"stage": None, "fraction": 1.0, "message": "", "eta_seconds": None}
    return _finish(session, lease, Status.SUCCEEDED, progress=progress, error=None)


def fail(session: Session, lease: Lease, code: str, detail: str, correctable: Sequence[str] = ()) -> bool:
    error = {"code": code, "detail": detail, "correctable": list(correctable)}
    return _finish(session, lease, Status.FAILED, error=error)


def give_back(session: Session, lease: Lease, reason: str, counts: bool = True) -> Status | None:
    """End an attempt that did not end by itself: the job is queued again, or fails after three fruitless ones.

    `counts=False` where the attempt is not to blame (the worker was told to stop). Returns the job's new
    status, None if the lease was lost.
    """
    fruitless = session.scalar(select(Job.fruitless_attempts).where(Job.id == lease.job_id)) or 0
    if counts and fruitless >= MOST_FRUITLESS_ATTEMPTS:
        detail = f"Tried {fruitless} times without getting any further. The last time: {reason}"
        return Status.FAILED if fail(session, lease, "attempts_exhausted", detail) else None
    requeued = change(
        session,
        lease,
        status=Status.QUEUED,
        enqueued_at=now(),
        lease_owner=None,
        lease_expires_at=None,
        fruitless_attempts=fruitless if counts else max(fruitless - 1, 0),
    )
    if not requeued:
        return None
    events.append(session, lease.job_id, "status", {"status": Status.QUEUED, "reason": reason})
    return Status.QUEUED


def expired(session: Session) -> list[tuple[str, Lease]]:
    """The running jobs whose worker has fallen silent: their kinds and leases."""
    query = select(Job).where(Job.status == Status.RUNNING, Job.lease_expires_at < now())
    return [(job.kind, Lease(job.id, job.lease_token, 0.0)) for job in session.scalars(query)]


def cancel(session: Session, job_id: str) -> bool:
    """Cancel a job that has not ended. It is canceled from then on, whatever its worker still does."""
    canceled = session.execute(
        update(Job)
        .where(Job.id == job_id, Job.status.in_([Status.QUEUED, Status.RUNNING]))
        .values(status=Status.CANCELED, finished_at=now(), lease_owner=None, lease_expires_at=None)
    )
    if not canceled.rowcount:  # type: ignore[attr-defined]
        return False
    events.append(session, job_id, "status", {"status": Status.CANCELED})
    return True


def _finish(session: Session, lease: Lease, status: Status, **values: Any) -> bool:
    ended = change(session, lease, status=status, finished_at=now(), lease_owner=None, lease_expires_at=None, **values)
    if ended:
        data = {"status": status} | ({"error": values["error"]} if values.get("error") else {})
        events.append(session, lease.job_id, "status", data)
    return ended
