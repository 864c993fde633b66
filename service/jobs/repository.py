"""Queries about jobs that change nothing of their course (for those, see `leases`)."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from sqlalchemy import delete, func, select, update
from sqlalchemy.orm import Session

from service.clock import now
from service.jobs.models import IdempotencyKey, Job, JobFile, Status


def get(session: Session, job_id: str) -> Job | None:
    return session.get(Job, job_id)


def page(
    session: Session,
    limit: int,
    before_id: str | None = None,
    statuses: Sequence[Status] = (),
    kinds: Sequence[str] = (),
    created_after: datetime | None = None,
    created_before: datetime | None = None,
) -> Sequence[Job]:
    """Jobs, newest first. Ids grow with time, so that one of them marks a place in the list."""
    query = select(Job).order_by(Job.id.desc()).limit(limit)
    if before_id is not None:
        query = query.where(Job.id < before_id)
    if statuses:
        query = query.where(Job.status.in_([status.value for status in statuses]))
    if kinds:
        query = query.where(Job.kind.in_(kinds))
    if created_after is not None:
        query = query.where(Job.created_at > created_after)
    if created_before is not None:
        query = query.where(Job.created_at < created_before)
    return session.scalars(query).all()


def files_of(session: Session, job_id: str) -> Sequence[str]:
    """The ids of the files that a job uses."""
    return session.scalars(select(JobFile.file_id).where(JobFile.job_id == job_id)).all()


def erase(session: Session, job_id: str) -> None:
    """Erase a job with its events, artifacts and keys (what they point at in the storage is another matter)."""
    session.execute(delete(Job).where(Job.id == job_id))


def idempotency_key(session: Session, key: str) -> IdempotencyKey | None:
    return session.get(IdempotencyKey, key)


def forget_idempotency_keys(session: Session, older_than: timedelta) -> None:
    session.execute(delete(IdempotencyKey).where(IdempotencyKey.created_at < now() - older_than))


def count_by_kind_and_status(session: Session) -> dict[tuple[str, str], int]:
    query = select(Job.kind, Job.status, func.count()).group_by(Job.kind, Job.status)
    return {(kind, status): count for kind, status, count in session.execute(query)}


def queued(session: Session, kind: str) -> Sequence[Job]:
    """The jobs of a kind that wait, oldest message first."""
    query = select(Job).where(Job.status == Status.QUEUED, Job.kind == kind).order_by(Job.enqueued_at)
    return session.scalars(query.limit(1000)).all()


def mark_enqueued(session: Session, job_id: str) -> None:
    session.execute(update(Job).where(Job.id == job_id).values(enqueued_at=now()))


def known(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are jobs."""
    return set(session.scalars(select(Job.id).where(Job.id.in_(ids))))
