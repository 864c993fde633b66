"""The table of uploaded files."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import BigInteger, ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime
from service.tables.stored import Stored


class File(Base):
    """An uploaded file. It lies in the storage under its id; its name is only shown."""

    __tablename__ = "files"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), index=True)
    name: Mapped[str] = mapped_column(String(255))
    content_type: Mapped[str] = mapped_column(String(100))
    size: Mapped[int] = mapped_column(BigInteger)
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)

    @property
    def key(self) -> str:
        return f"files/{self.id}"

    @property
    def stored(self) -> Stored:
        """How it is sent."""
        return Stored(self.key, self.name, self.content_type, self.size, self.sha256, self.created_at)
