"""Queries about jobs that change nothing of their course (for those, see `leases`)."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, delete, exists, func, or_, select, update
from sqlalchemy.orm import Session, aliased

from service.clock import now
from service.tables.base import SET_BACK_SECONDS, moment_in
from service.tables.jobs import IdempotencyKey, Job, JobFile, Status
from service.tables.kept import KEPT_TABLES


def get(session: Session, job_id: str) -> Job | None:
    return session.get(Job, job_id)


def get_locked(session: Session, job_id: str) -> Job | None:
    """A job that nobody else changes or erases until this transaction ends."""
    return session.get(Job, job_id, with_for_update=True, populate_existing=True)


def of_kind_locked(session: Session, owner: str, kind: str) -> Sequence[Job]:
    """An owner's jobs of a kind, oldest first, that nobody else changes or erases until this transaction ends."""
    query = select(Job).where(Job.owner == owner, Job.kind == kind).order_by(Job.id).with_for_update()
    return session.scalars(query).all()


def page(
    session: Session,
    owner: str,
    limit: int,
    before_id: str | None = None,
    statuses: Sequence[Status] = (),
    kinds: Sequence[str] = (),
    created_after: datetime | None = None,
    created_before: datetime | None = None,
    words: Sequence[str] = (),
    latest: bool = False,
) -> Sequence[Job]:
    """An owner's jobs, newest first; with `words`, those that are found by every one; with `latest`, of each tree the
    newest that is let through. Ids grow with time, so that one of them marks a place in the list."""

    def let_through(job: type[Job]) -> list[ColumnElement[bool]]:
        wanted = [job.owner == owner]
        if statuses:
            wanted.append(job.status.in_([status.value for status in statuses]))
        if kinds:
            wanted.append(job.kind.in_(kinds))
        if created_after is not None:
            wanted.append(job.created_at > created_after)
        if created_before is not None:
            wanted.append(job.created_at < created_before)
        return wanted + [job.search.contains(word, autoescape=True) for word in words]

    query = select(Job).where(*let_through(Job)).order_by(Job.id.desc()).limit(limit)
    if before_id is not None:
        query = query.where(Job.id < before_id)
    if latest:
        newer = aliased(Job)
        query = query.where(~exists().where(newer.tree == Job.tree, newer.id > Job.id, *let_through(newer)))
    return session.scalars(query).all()


def versions(session: Session, owner: str, trees: Collection[str]) -> dict[str, int]:
    """How many of an owner's jobs belong to each of these trees."""
    query = select(Job.tree, func.count()).where(Job.owner == owner, Job.tree.in_(trees)).group_by(Job.tree)
    return dict(session.execute(query).tuples().all())


def files_of(session: Session, job_id: str) -> Sequence[str]:
    """The ids of the files that a job uses."""
    return session.scalars(select(JobFile.file_id).where(JobFile.job_id == job_id)).all()


def tree(session: Session, root: str) -> Sequence[Job]:
    """A job and its revisions, oldest first."""
    return session.scalars(select(Job).where(Job.tree == root).order_by(Job.id)).all()


def lock_tree(session: Session, root: str) -> None:
    """Let nobody change, erase or revise a job or its revisions until this transaction ends."""
    session.execute(select(Job.id).where(Job.tree == root).order_by(Job.id).with_for_update())


def erase(session: Session, job_id: str) -> None:
    """Erase a job with its events, artifacts and keys (what they point at in the storage is another matter)."""
    session.execute(delete(Job).where(Job.id == job_id))


def idempotency_key(session: Session, owner: str, key: str) -> IdempotencyKey | None:
    return session.get(IdempotencyKey, (owner, key))


def forget_idempotency_keys(session: Session, older_than: timedelta) -> None:
    session.execute(delete(IdempotencyKey).where(IdempotencyKey.created_at < now() - older_than))


def count_by_kind_and_status(session: Session) -> dict[tuple[str, str], int]:
    query = select(Job.kind, Job.status, func.count()).group_by(Job.kind, Job.status)
    return {(kind, status): count for kind, status, count in session.execute(query)}


def oldest_queued(session: Session) -> dict[str, datetime]:
    """Since when the oldest queued job of each kind has waited."""
    query = select(Job.kind, func.min(Job.created_at)).where(Job.status == Status.QUEUED).group_by(Job.kind)
    return dict(session.execute(query).tuples().all())


def end_states(session: Session, ids: Sequence[str]) -> dict[str, tuple[Status, dict[str, Any] | None]]:
    """Where those of these jobs stand that there are, and why they failed."""
    query = select(Job.id, Job.status, Job.error).where(Job.id.in_(ids))
    return {one: (Status(status), error) for one, status, error in session.execute(query)}


def queued(session: Session, kind: str, seconds: float) -> Sequence[Job]:
    """The jobs of a kind whose message was sent so long ago (or before the clock was set back) and that still wait,
    oldest message first."""
    overdue = or_(Job.enqueued_at < moment_in(-seconds), Job.enqueued_at > moment_in(SET_BACK_SECONDS))
    query = select(Job).where(Job.status == Status.QUEUED, Job.kind == kind, overdue)
    return session.scalars(query.order_by(Job.enqueued_at).limit(1000)).all()


def running(session: Session, ids: Sequence[str]) -> set[str]:
    """Those of these jobs that a worker has."""
    return set(session.scalars(select(Job.id).where(Job.id.in_(ids), Job.status == Status.RUNNING)))


def queue_places(session: Session, jobs: Sequence[Job]) -> dict[str, int]:
    """The places of these jobs among those of their kind that are queued, counted from 1.

    The order is that of `fair_queue.claim_next`: by priority, then one of each key in turn, then by age. Keys of which fewer
    jobs run come first.
    """
    if not jobs:
        return {}
    other = aliased(Job)
    running = (
        select(other.owner, func.count().label("jobs"))
        .where(other.status == Status.RUNNING)
        .group_by(other.owner)
        .subquery()
    )
    own = func.row_number().over(partition_by=(Job.kind, Job.owner), order_by=(Job.priority, Job.id))
    waiting = (
        select(Job.id, Job.kind, Job.priority, (own + func.coalesce(running.c.jobs, 0)).label("round"))
        .outerjoin(running, running.c.owner == Job.owner)
        .where(Job.status == Status.QUEUED, Job.kind.in_({job.kind for job in jobs}))
        .subquery()
    )
    order = (waiting.c.priority, waiting.c.round, waiting.c.id)
    place = func.row_number().over(partition_by=waiting.c.kind, order_by=order)
    placed = select(waiting.c.id, place.label("place")).subquery()
    query = select(placed.c.id, placed.c.place).where(placed.c.id.in_([job.id for job in jobs]))
    return {row.id: row.place for row in session.execute(query)}


def count_queued(session: Session, kind: str) -> int:
    query = select(func.count()).where(Job.status == Status.QUEUED, Job.kind == kind)
    return session.scalar(query) or 0


def ended_before(session: Session, moment: datetime, most: int) -> Sequence[Job]:
    """Some jobs that ended before a moment, oldest first. What was found in something that a user keeps is kept
    as long as that."""
    query = select(Job).where(Job.finished_at < moment)
    for table in KEPT_TABLES:
        query = query.where(Job.id.not_in(select(table.inspection_job).where(table.inspection_job.is_not(None))))
    return session.scalars(query.order_by(Job.finished_at).limit(most)).all()


def mark_enqueued(session: Session, job_id: str) -> None:
    session.execute(update(Job).where(Job.id == job_id).values(enqueued_at=moment_in()))


def existing_ids(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are jobs."""
    return set(session.scalars(select(Job.id).where(Job.id.in_(ids))))


def with_folder(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids still need their folder: they are jobs, or there are revisions of them."""
    return existing_ids(session, ids) | set(session.scalars(select(Job.tree).where(Job.tree.in_(ids))))
