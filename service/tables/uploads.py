"""The table of resumable uploads."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import BigInteger, ForeignKey, Index, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime


class Upload(Base):
    """An upload that comes in pieces. What has come lies in the spool under its id; once all is there, it becomes the
    file with the same id, and this record goes when that file does."""

    __tablename__ = "uploads"
    __table_args__ = (Index("uploads_by_expiry", "expires_at"),)

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), index=True)
    name: Mapped[str] = mapped_column(String(255))
    declared: Mapped[str] = mapped_column(String(100))
    """The media type that the client names; empty if it names none."""
    notes: Mapped[str | None] = mapped_column("metadata", Text)
    """`Upload-Metadata` as it was sent."""
    length: Mapped[int | None] = mapped_column(BigInteger)
    """How long it will be; null as long as the client has not said."""
    received: Mapped[int] = mapped_column(BigInteger)
    """The protocol's offset: as many bytes are safely on disk. It reaches the length only together with the file."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
    expires_at: Mapped[datetime] = mapped_column(UTCDateTime)
    """When it is erased unless more of it comes."""
    file_id: Mapped[str | None] = mapped_column(ForeignKey("files.id", ondelete="CASCADE"), index=True)

    @property
    def finished(self) -> bool:
        return self.file_id is not None
