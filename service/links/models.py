"""The table of public links."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import JSON, ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.database import Base, UTCDateTime


class PublicLink(Base):
    """That a job's owner lets everybody who knows the token read its artifacts, or some of them."""

    __tablename__ = "public_links"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    token: Mapped[str] = mapped_column(String(64), unique=True)
    """Kept as it is, so that its owner can be shown the address again; it opens nothing but this job's results."""
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"))
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), index=True)
    names: Mapped[list[str] | None] = mapped_column(JSON(none_as_null=True))
    """The artifacts that it opens; null: all of them."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
    expires_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
