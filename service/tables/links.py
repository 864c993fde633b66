"""The table of public links."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import JSON, ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime


class PublicLink(Base):
    """That a job's owner lets everybody who knows the token read its artifacts, or some of them."""

    __tablename__ = "public_links"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    token_hash: Mapped[str] = mapped_column(String(64), unique=True)
    """SHA-256 of the token, which is 192 random bits and kept nowhere: its address is shown once."""
    hint: Mapped[str] = mapped_column(String(16))
    """The token's first characters, to tell links apart."""
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), index=True)
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id", ondelete="CASCADE"), index=True)
    names: Mapped[list[str] | None] = mapped_column(JSON(none_as_null=True))
    """The artifacts that it opens; null: all of them."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
    expires_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
