"""Queries about events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.clock import now
from service.events.models import Event


def append(session: Session, job_id: str, type_: str, data: dict[str, Any]) -> None:
    """Add an event, in the same transaction as the change that it tells of."""
    session.add(Event(job_id=job_id, type=type_, data=data, created_at=now()))


def after(session: Session, job_id: str, event_id: int, limit: int = 200) -> Sequence[Event]:
    """A job's events that came after one, oldest first."""
    query = select(Event).where(Event.job_id == job_id, Event.id > event_id).order_by(Event.id).limit(limit)
    return session.scalars(query).all()
