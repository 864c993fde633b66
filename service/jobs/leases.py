"""The course of a job, as workers change it: claimed by a lease, renewed by a heartbeat, fenced by a token.

Each function is one guarded UPDATE and returns whether it still applied. A worker whose lease was lost (the
job was canceled or erased, or another worker took over) can change nothing any more. The UPDATE comes first in its
transaction: it locks the job's row, so that what follows in the same transaction stands on firm ground.

How long a lease lasts is measured by the database's clock alone: the clocks of the machines may differ.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, case, or_, select, update
from sqlalchemy.orm import Session

from service.events import repository as events
from service.figures import counters
from service.tables.base import SET_BACK_SECONDS, moment_in
from service.tables.jobs import Job, Status

MAX_FRUITLESS_ATTEMPTS = 3


@dataclass(frozen=True)
class Lease:
    """The right to work on a job."""

    job_id: str
    token: int
    seconds: float


def claim(session: Session, job_id: str, owner: str, seconds: float) -> Lease | None:
    """Take a queued job; None if it is not queued (any more), so that a message delivered twice runs once."""
    taken = session.execute(
        update(Job)
        .where(Job.id == job_id, Job.status == Status.QUEUED)
        .values(
            status=Status.RUNNING,
            started_at=case((Job.started_at.is_(None), moment_in()), else_=Job.started_at),
            lease_owner=owner,
            lease_token=Job.lease_token + 1,
            lease_expires_at=moment_in(seconds),
            attempts=Job.attempts + 1,
            fruitless_attempts=Job.fruitless_attempts + 1,
        )
    )
    if taken.rowcount == 0:  # type: ignore[attr-defined]
        return None
    token = session.scalar(select(Job.lease_token).where(Job.id == job_id))
    events.append(session, job_id, "status", {"status": Status.RUNNING})
    return Lease(job_id, int(token or 0), seconds)


def is_held(session: Session, lease: Lease) -> bool:
    """Whether the lease still stands; reads only."""
    query = select(Job.id).where(Job.id == lease.job_id, Job.lease_token == lease.token, Job.status == Status.RUNNING)
    return session.scalar(query) is not None


def update_job(session: Session, lease: Lease, **values: Any) -> bool:
    """Change columns of the job if the lease still stands, and renew the lease."""
    values.setdefault("lease_expires_at", moment_in(lease.seconds))
    changed = session.execute(
        update(Job)
        .where(Job.id == lease.job_id, Job.lease_token == lease.token, Job.status == Status.RUNNING)
        .values(**values)
    )
    return bool(changed.rowcount)  # type: ignore[attr-defined]


def report_progress(
    session: Session, lease: Lease, progress: dict[str, Any], stages: Sequence[str] = (), begun: bool = False
) -> bool:
    """Record progress, and the stages so far in their order; who follows is told of these when one more has `begun`."""
    whole = progress | {"stages": list(stages)}
    if not update_job(session, lease, progress=whole, progress_at=moment_in()):
        return False
    events.append(session, lease.job_id, "progress", whole if begun else progress)
    return True


def note_waiting(session: Session, job_id: str, progress: dict[str, Any]) -> bool:
    """Record what a job waits for; a job that waits no more is left alone."""
    noted = session.execute(update(Job).where(Job.id == job_id, Job.status == Status.QUEUED).values(progress=progress))
    if not noted.rowcount:  # type: ignore[attr-defined]
        return False
    events.append(session, job_id, "progress", progress)
    return True


def note_new_stage(session: Session, lease: Lease) -> bool:
    """Record that a new stage was stored: this attempt was not in vain."""
    return update_job(session, lease, fruitless_attempts=0)


def succeed(session: Session, lease: Lease) -> bool:
    before = session.scalar(select(Job.progress).where(Job.id == lease.job_id)) or {}
    progress = {"stage": None, "fraction": 1.0, "message": "", "eta_seconds": None}
    progress["stages"] = before.get("stages", [])
    return _finish(session, lease, Status.SUCCEEDED, progress=progress, error=None)


def fail(
    session: Session,
    lease: Lease,
    code: str,
    detail: str,
    correctable: Sequence[str] = (),
    found: Mapping[str, Any] | None = None,
) -> bool:
    error = {"code": code, "detail": detail, "correctable": list(correctable), "found": dict(found or {})}
    return _finish(session, lease, Status.FAILED, error=error)


def give_back(
    session: Session,
    lease: Lease,
    reason: str,
    counts: bool = True,
    only_expired: bool = False,
    death: str | None = None,
) -> Status | None:
    """End an attempt that did not end by itself: the job is queued again, or fails after three fruitless ones.

    `death` is how its process died where it did so by itself: one that dies a second time in the same way, and got no
    further, would do so a third time. `counts=False` where the attempt is not to blame (the worker was told to stop);
    `only_expired` where the worker may have renewed its lease in the meantime. Returns the job's new status, None if the lease was lost (or stands).
    """
    mine = select(Job.fruitless_attempts, Job.last_death).where(Job.id == lease.job_id, Job.lease_token == lease.token)
    if only_expired:
        mine = mine.where(_over())
    found = session.execute(mine.with_for_update()).one_or_none()
    if found is None:
        return None
    fruitless, last_death = found
    if counts and fruitless and death is not None and death == last_death:
        detail = f"Tried twice, and it ended in the same way: {reason}. Send another file, or the same one saved anew."
        return Status.FAILED if fail(session, lease, "process_died", detail) else None
    if counts and fruitless >= MAX_FRUITLESS_ATTEMPTS:
        detail = f"Tried {fruitless} times without getting any further. The last time: {reason}"
        return Status.FAILED if fail(session, lease, "attempts_exhausted", detail) else None
    requeued = update_job(
        session,
        lease,
        status=Status.QUEUED,
        enqueued_at=moment_in(),
        lease_owner=None,
        lease_expires_at=None,
        fruitless_attempts=fruitless if counts else max(fruitless - 1, 0),
        last_death=death if counts else last_death,
    )
    if not requeued:
        return None
    events.append(session, lease.job_id, "status", {"status": Status.QUEUED, "reason": reason})
    return Status.QUEUED


def expired(session: Session) -> list[tuple[str, Lease]]:
    """The running jobs whose worker has fallen silent: their kinds and leases."""
    query = select(Job).where(Job.status == Status.RUNNING, _over())
    return [(job.kind, Lease(job.id, job.lease_token, 0.0)) for job in session.scalars(query)]


def _over() -> ColumnElement[bool]:
    """Whether a lease has ended, or was given before the clock was set back: it would hold its job for too long."""
    return or_(Job.lease_expires_at < moment_in(), Job.lease_expires_at > moment_in(SET_BACK_SECONDS))


def cancel(session: Session, job_id: str) -> bool:
    """Cancel a job that has not ended. It is canceled from then on, whatever its worker still does."""
    canceled = session.execute(
        update(Job)
        .where(Job.id == job_id, Job.status.in_([Status.QUEUED, Status.RUNNING]))
        .values(status=Status.CANCELED, finished_at=moment_in(), lease_owner=None, lease_expires_at=None)
    )
    if not canceled.rowcount:  # type: ignore[attr-defined]
        return False
    events.append(session, job_id, "status", {"status": Status.CANCELED})
    _count(session, job_id, Status.CANCELED, "")
    return True


def _finish(session: Session, lease: Lease, status: Status, **values: Any) -> bool:
    values |= {"status": status, "finished_at": moment_in(), "lease_owner": None, "lease_expires_at": None}
    ended = update_job(session, lease, **values)
    if ended:
        data = {"status": status} | ({"error": values["error"]} if values.get("error") else {})
        events.append(session, lease.job_id, "status", data)
        _count(session, lease.job_id, status, (values.get("error") or {}).get("code", ""))
    return ended


def count_stages(session: Session, lease: Lease, seconds: Mapping[str, float]) -> None:
    """Count how long the stages of a job took that has just succeeded."""
    kind = _kind(session, lease.job_id)
    for stage, spent in sorted(seconds.items()):  # in one order, so that two that end at once cannot block each other
        counters.add(session, "galatea_stage_seconds", kind, stage, amount=spent)
        counters.add(session, "galatea_stage_runs", kind, stage)


def _count(session: Session, job_id: str, status: Status, code: str) -> None:
    counters.add(session, "galatea_jobs_ended", _kind(session, job_id), status.value, code)


def _kind(session: Session, job_id: str) -> str:
    return session.scalar(select(Job.kind).where(Job.id == job_id)) or ""
