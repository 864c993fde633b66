"""The tables of jobs: what was asked, how far it is, and who holds the lease on it."""

from __future__ import annotations

from datetime import datetime
from enum import IntEnum, StrEnum
from typing import Any

from sqlalchemy import JSON, ForeignKey, Index, SmallInteger, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime

TITLE_CHARACTERS = 200
TRACEPARENT_CHARACTERS = 55
TITLE_PATTERN = r"^[^\x00-\x1f\x7f]*$"


class Status(StrEnum):
    """Where a job stands."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"

    @property
    def final(self) -> bool:
        return self not in (Status.QUEUED, Status.RUNNING)


class Priority(IntEnum):
    """Which jobs of a kind come first: the smaller."""

    HIGH = 1
    NORMAL = 2
    LOW = 3


class Job(Base):
    """One job."""

    __tablename__ = "jobs"
    __table_args__ = (
        Index("jobs_by_status", "status", "kind", "enqueued_at"),
        Index("jobs_in_turn", "status", "kind", "priority", "id"),
        Index("jobs_by_kind", "kind", "id"),
        Index("jobs_by_tree", "tree", "id"),
        Index("jobs_by_owner", "owner", "status"),
    )

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"))
    kind: Mapped[str] = mapped_column(String(64))
    status: Mapped[str] = mapped_column(String(16))
    priority: Mapped[int] = mapped_column(SmallInteger, default=Priority.NORMAL)
    revision_of: Mapped[str | None] = mapped_column(String(36))
    """The job that this one corrects; it may have been erased since."""
    tree: Mapped[str] = mapped_column(String(36), default=lambda context: context.get_current_parameters()["id"])
    """The job that was revised first, or this one: a tree shares its stored stages."""
    title: Mapped[str | None] = mapped_column(String(TITLE_CHARACTERS))
    """What the client calls the work; all jobs of a tree have the same."""
    search: Mapped[str] = mapped_column(Text, default="")
    """By what words it is found (`service.job_records.search`): a line for the title, and one for each name."""
    inputs: Mapped[dict[str, Any]] = mapped_column(JSON)
    """As the client gave them: file ids and names of drivers."""
    sources: Mapped[dict[str, Any]] = mapped_column(JSON)
    """As the worker needs them: `{"file": id}` or `{"library": ..., "name": ...}`; `{"url": ...}` until that was fetched.
    An input that takes many has a list of them."""
    options: Mapped[dict[str, Any]] = mapped_column(JSON)
    notes: Mapped[dict[str, Any]] = mapped_column("metadata", JSON)
    """The client's own metadata."""
    progress: Mapped[dict[str, Any]] = mapped_column(JSON)
    progress_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    webhook_url: Mapped[str | None] = mapped_column(String(2000))
    """An address of its own to be told."""
    webhook_events: Mapped[list[str] | None] = mapped_column(JSON(none_as_null=True))
    """What `webhook_url` is told of; null for the end of the job alone."""
    error: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    request: Mapped[str | None] = mapped_column(String(64))
    """The id of the request that submitted it."""
    trace: Mapped[str | None] = mapped_column(String(TRACEPARENT_CHARACTERS))
    """That request's span, as a `traceparent`: what is done for the job belongs to the same trace, wherever it is done."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
    started_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    finished_at: Mapped[datetime | None] = mapped_column(UTCDateTime)

    enqueued_at: Mapped[datetime] = mapped_column(UTCDateTime)
    """When its message was last sent; the sweep sends another when that one was lost."""
    lease_owner: Mapped[str | None] = mapped_column(String(128))
    lease_token: Mapped[int] = mapped_column(default=0)
    """Grows with every claim: whoever holds an older one can no longer change the job (a fencing token)."""
    lease_expires_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    attempts: Mapped[int] = mapped_column(default=0)
    fruitless_attempts: Mapped[int] = mapped_column(default=0)
    """Attempts in a row that stored no new stage."""
    last_death: Mapped[str | None] = mapped_column(String(32))
    """How the process of the last attempt died where it did so by itself (`SIGABRT`)."""


class JobFile(Base):
    """That a job uses a file: a file that is used is not erased."""

    __tablename__ = "job_files"
    __table_args__ = (Index("job_files_by_file", "file_id"),)

    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    file_id: Mapped[str] = mapped_column(ForeignKey("files.id"), primary_key=True)


class IdempotencyKey(Base):
    """Which job an `Idempotency-Key` made, and of what request."""

    __tablename__ = "idempotency_keys"

    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), primary_key=True)
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(String(64))
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), index=True)
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
