"""Queries about endpoints and deliveries that change nothing of a delivery's course (for those, see `delivery_lease`)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import delete, func, or_, select
from sqlalchemy.orm import Session

from service.tables.webhooks import Delivery, DeliveryAttempt, DeliveryStatus, Webhook


@dataclass(frozen=True)
class DeliveryFilter:
    """Which deliveries a list shows."""

    statuses: Sequence[DeliveryStatus] = ()
    events: Sequence[str] = ()
    job_id: str | None = None
    webhook_id: str | None = None


@dataclass(frozen=True)
class Backlog:
    """What is still to be delivered to addresses that take it."""

    pending: int
    oldest: datetime | None
    """When the oldest of them was written."""
    due: datetime | None
    """Since when the one that has waited longest for its next attempt could have had it."""


def get(session: Session, owner: str, webhook_id: str) -> Webhook | None:
    """An owner's endpoint."""
    return session.scalar(select(Webhook).where(Webhook.id == webhook_id, Webhook.owner == owner))


def of_owner(session: Session, owner: str) -> Sequence[Webhook]:
    """An owner's endpoints, oldest first."""
    return session.scalars(select(Webhook).where(Webhook.owner == owner).order_by(Webhook.id)).all()


def enabled(session: Session, owner: str) -> Sequence[Webhook]:
    """An owner's endpoints that take messages."""
    return session.scalars(select(Webhook).where(Webhook.owner == owner, Webhook.enabled).order_by(Webhook.id)).all()


def count(session: Session, owner: str) -> int:
    return session.scalar(select(func.count()).select_from(Webhook).where(Webhook.owner == owner)) or 0


def erase(session: Session, webhook_id: str) -> None:
    """Erase an endpoint with its deliveries."""
    session.execute(delete(Webhook).where(Webhook.id == webhook_id))


def erase_all(session: Session, owner: str) -> None:
    """Erase an owner's endpoints and all deliveries."""
    session.execute(delete(Delivery).where(Delivery.owner == owner))
    session.execute(delete(Webhook).where(Webhook.owner == owner))


def delivery(session: Session, owner: str, delivery_id: str) -> Delivery | None:
    """An owner's delivery."""
    return session.scalar(select(Delivery).where(Delivery.id == delivery_id, Delivery.owner == owner))


def deliveries(
    session: Session, owner: str, wanted: DeliveryFilter, limit: int, before_id: str | None
) -> Sequence[Delivery]:
    """An owner's deliveries, newest first. Ids grow with time, so that one of them marks a place in the list."""
    query = select(Delivery).where(Delivery.owner == owner).order_by(Delivery.id.desc()).limit(limit)
    if before_id is not None:
        query = query.where(Delivery.id < before_id)
    if wanted.statuses:
        query = query.where(Delivery.status.in_([status.value for status in wanted.statuses]))
    if wanted.events:
        query = query.where(Delivery.event.in_(wanted.events))
    if wanted.job_id is not None:
        query = query.where(Delivery.job_id == wanted.job_id)
    if wanted.webhook_id is not None:
        query = query.where(Delivery.webhook_id == wanted.webhook_id)
    return session.scalars(query).all()


def attempts(session: Session, delivery_ids: Sequence[str]) -> Mapping[str, list[DeliveryAttempt]]:
    """The attempts at deliveries, oldest first."""
    made: dict[str, list[DeliveryAttempt]] = defaultdict(list)
    query = select(DeliveryAttempt).where(DeliveryAttempt.delivery_id.in_(delivery_ids)).order_by(DeliveryAttempt.id)
    for attempt in session.scalars(query):
        made[attempt.delivery_id].append(attempt)
    return made


def backlog(session: Session) -> Backlog:
    """What is still to be delivered."""
    query = (
        select(func.count(), func.min(Delivery.created_at), func.min(Delivery.next_attempt_at))
        .outerjoin(Webhook, Webhook.id == Delivery.webhook_id)
        .where(Delivery.status == DeliveryStatus.PENDING, or_(Delivery.webhook_id.is_(None), Webhook.enabled))
    )
    return Backlog(*session.execute(query).one())


def forget(session: Session, before: datetime) -> None:
    """Erase the deliveries that were written before a moment, with their attempts."""
    session.execute(delete(Delivery).where(Delivery.created_at < before))
