"""The table of artifacts."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import BigInteger, ForeignKey, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime
from service.tables.stored import Stored


class Artifact(Base):
    """A published artifact of a job. It lies in the storage under its id, so that a newer one of the same
    name replaces it by one change here, while whoever reads the older one keeps what he has."""

    __tablename__ = "artifacts"
    __table_args__ = (UniqueConstraint("job_id", "name", name="artifact_of_job"),)

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(String(128))
    content_type: Mapped[str] = mapped_column(String(100))
    size: Mapped[int] = mapped_column(BigInteger)
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)

    @property
    def key(self) -> str:
        return f"artifacts/{self.id}"

    @property
    def stored(self) -> Stored:
        """How it is sent."""
        return Stored(self.key, self.name, self.content_type, self.size, self.sha256, self.created_at)
