"""Queries about events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Integer, bindparam, func, select
from sqlalchemy.orm import Session

from service.clock import now
from service.tables.events import Event
from service.tables.jobs import Job
from service.webhooks import outbox

EVENTS_AFTER = (
    select(Event)
    .where(Event.job_id == bindparam("job"), Event.id > bindparam("last"))
    .order_by(Event.id)
    .limit(bindparam("most", type_=Integer))
)


def append(session: Session, job_id: str, type_: str, data: dict[str, Any]) -> None:
    """Add an event and the webhooks that tell of it, in the same transaction as the change itself.

    The events of a job become visible in the order of their ids: a follower that has seen one would never see a smaller
    one that came later. So an id is drawn only once the job's row is locked, which lasts until the event is there.
    """
    session.execute(select(Job.id).where(Job.id == job_id).with_for_update(key_share=True))
    event = Event(job_id=job_id, type=type_, data=data, created_at=now())
    session.add(event)
    session.flush()
    outbox.write(session, event)


def append_first(session: Session, job: Job) -> None:
    """Add the first event of a job that this transaction makes: nobody knows of it yet, nor is told of it."""
    session.add(Event(job_id=job.id, type="status", data={"status": job.status}, created_at=job.created_at))


def events_after(session: Session, job_id: str, event_id: int, limit: int = 200) -> Sequence[Event]:
    """A job's events that came after one, oldest first."""
    return session.scalars(EVENTS_AFTER, {"job": job_id, "last": event_id, "most": limit}).all()


def newest(session: Session) -> int:
    """The id of the newest event of all; 0 where there is none."""
    return session.scalar(select(func.max(Event.id))) or 0


def jobs_since(session: Session, event_id: int) -> list[tuple[int, str]]:
    """The ids of all events that came after one, each with its job's."""
    query = select(Event.id, Event.job_id).where(Event.id > event_id)
    return [(number, job_id) for number, job_id in session.execute(query)]
