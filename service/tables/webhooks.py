"""The tables of webhooks: endpoints, what is to be delivered (the outbox), and every attempt at it."""

from __future__ import annotations

from datetime import datetime
from enum import StrEnum
from typing import Any

from sqlalchemy import JSON, BigInteger, Float, ForeignKey, Index, Integer, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, Sealed, UTCDateTime
from service.vault import Secret

URL_CHARACTERS = 2000


class EventType(StrEnum):
    """What can be told of a job."""

    SUCCEEDED = "job.succeeded"
    FAILED = "job.failed"
    CANCELED = "job.canceled"
    PROGRESS = "job.progress"


FINAL_EVENTS = (EventType.SUCCEEDED, EventType.FAILED, EventType.CANCELED)
"""What is told unless more is asked for."""

TEST_EVENT = "webhook.test"
"""What an endpoint is told to try it."""


class DeliveryStatus(StrEnum):
    """Where a delivery stands."""

    PENDING = "pending"
    DELIVERED = "delivered"
    FAILED = "failed"


class Webhook(Base):
    """An endpoint: an address that is told of its owner's jobs."""

    __tablename__ = "webhooks"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), index=True)
    url: Mapped[str] = mapped_column(String(URL_CHARACTERS))
    description: Mapped[str] = mapped_column(String(500))
    events: Mapped[list[str]] = mapped_column(JSON)
    enabled: Mapped[bool]
    disabled_code: Mapped[str | None] = mapped_column(String(16))
    """Why the service disabled it; null where its owner did."""
    disabled_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    failing_since: Mapped[datetime | None] = mapped_column(UTCDateTime)
    """The first attempt that failed after the last one that succeeded."""
    given_up: Mapped[int] = mapped_column(default=0)
    """Deliveries whose last attempt failed since then."""
    secret: Mapped[Secret] = mapped_column(Sealed)
    previous_secret: Mapped[Secret | None] = mapped_column(Sealed)
    previous_until: Mapped[datetime | None] = mapped_column(UTCDateTime)
    """Until then the previous secret signs too."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)


class Delivery(Base):
    """One message for one address: to an endpoint, or to the address that a job named itself. Its id is the message's
    `webhook-id`, the same at every attempt."""

    __tablename__ = "webhook_deliveries"
    __table_args__ = (
        Index("webhook_deliveries_due", "status", "next_attempt_at"),
        Index("webhook_deliveries_by_owner", "owner", "id"),
        Index("webhook_deliveries_by_job", "job_id", "event"),
        Index("webhook_deliveries_by_webhook", "webhook_id", "id"),
    )

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"))
    webhook_id: Mapped[str | None] = mapped_column(ForeignKey("webhooks.id", ondelete="CASCADE"))
    """The endpoint; null where the job named the address itself."""
    job_id: Mapped[str | None] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    event: Mapped[str] = mapped_column(String(32))
    sequence: Mapped[int | None] = mapped_column(BigInteger)
    """The job's event that it tells of: of two messages, the later one has the higher number."""
    url: Mapped[str] = mapped_column(String(URL_CHARACTERS))
    host: Mapped[str] = mapped_column(String(255))
    """The host in it; a slow one gets only a part of the attempts that go on at once."""
    payload: Mapped[dict[str, Any]] = mapped_column(JSON)
    """The message's `data`, without what depends on the moment of the attempt."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime, index=True)
    status: Mapped[str] = mapped_column(String(16))
    next_attempt_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    """Null once nothing more will be tried."""
    tries: Mapped[int] = mapped_column(default=0)
    """Attempts that failed since it was written, or sent again on request."""
    delivered_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    lease_token: Mapped[int] = mapped_column(default=0)
    """Grows with every attempt: a worker that was given up for lost can record nothing any more."""
    lease_expires_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    """Until then nobody else may try; null while nobody does."""


class DeliveryAttempt(Base):
    """One attempt at a delivery, and what came of it."""

    __tablename__ = "webhook_attempts"

    id: Mapped[int] = mapped_column(BigInteger().with_variant(Integer, "sqlite"), primary_key=True)
    delivery_id: Mapped[str] = mapped_column(ForeignKey("webhook_deliveries.id", ondelete="CASCADE"), index=True)
    started_at: Mapped[datetime] = mapped_column(UTCDateTime)
    seconds: Mapped[float] = mapped_column(Float)
    response_status: Mapped[int | None]
    """Null where there was no answer."""
    response_excerpt: Mapped[str] = mapped_column(Text)
    error_code: Mapped[str | None] = mapped_column(String(32))
    """Null where it succeeded."""
    error_detail: Mapped[str | None] = mapped_column(Text)
