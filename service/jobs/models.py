"""The tables of jobs: what was asked, how far it is, and who holds the lease on it."""

from __future__ import annotations

from datetime import datetime
from enum import StrEnum
from typing import Any

from sqlalchemy import JSON, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.database import Base, UTCDateTime


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


class Job(Base):
    """One job."""

    __tablename__ = "jobs"
    __table_args__ = (
        Index("jobs_by_status", "status", "kind", "enqueued_at"),
        Index("jobs_by_kind", "kind", "id"),
    )

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    kind: Mapped[str] = mapped_column(String(64))
    status: Mapped[str] = mapped_column(String(16))
    inputs: Mapped[dict[str, Any]] = mapped_column(JSON)
    """As the client gave them: file ids and names of drivers."""
    sources: Mapped[dict[str, Any]] = mapped_column(JSON)
    """As the worker needs them: `{"file": id}` or `{"library": ..., "name": ...}`, a list where many."""
    options: Mapped[dict[str, Any]] = mapped_column(JSON)
    notes: Mapped[dict[str, Any]] = mapped_column("metadata", JSON)
    """The client's own metadata."""
    progress: Mapped[dict[str, Any]] = mapped_column(JSON)
    progress_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    error: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
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


class JobFile(Base):
    """That a job uses a file: a file that is used is not erased."""

    __tablename__ = "job_files"
    __table_args__ = (Index("job_files_by_file", "file_id"),)

    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), primary_key=True)
    file_id: Mapped[str] = mapped_column(ForeignKey("files.id"), primary_key=True)


class IdempotencyKey(Base):
    """Which job an `Idempotency-Key` made, and of what request."""

    __tablename__ = "idempotency_keys"

    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(String(64))
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), index=True)
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
