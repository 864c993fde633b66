"""The table of the user's own drivers."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.database import Base, UTCDateTime


class Driver(Base):
    """A driving video that a user keeps under a name."""

    __tablename__ = "drivers"

    name: Mapped[str] = mapped_column(String(64), primary_key=True)
    file_id: Mapped[str] = mapped_column(ForeignKey("files.id"), index=True)
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
