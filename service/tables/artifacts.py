"""The table of artifacts."""

from __future__ import annotations

from sqlalchemy import ForeignKey, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base
from service.tables.stored import InStorage


class Artifact(InStorage, Base):
    """A published artifact of a job. It lies in the storage under its id, so that a newer one of the same
    name replaces it by one change here, while whoever reads the older one keeps what he has."""

    __tablename__ = "artifacts"
    __table_args__ = (UniqueConstraint("job_id", "name", name="artifact_of_job"),)

    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"))
    name: Mapped[str] = mapped_column(String(128))
