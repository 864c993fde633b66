"""The tables of what users keep under names, each beside a built-in library of the same things."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, UTCDateTime


class Kept(Base):
    """A file that a user keeps under a name."""

    __abstract__ = True

    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), primary_key=True)
    name: Mapped[str] = mapped_column(String(64), primary_key=True)
    file_id: Mapped[str] = mapped_column(ForeignKey("files.id"), index=True)
    inspection_job: Mapped[str | None] = mapped_column(String(36), index=True)
    """The job that inspects it; it may have been erased since."""
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)


class Driver(Kept):
    """A driving video that a user keeps under a name."""

    __tablename__ = "drivers"

    inspection_job: Mapped[str | None] = mapped_column("moments_job", String(36), index=True)


class Motion(Kept):
    """A motion file that a user keeps under a name."""

    __tablename__ = "motions"

    inspection_job: Mapped[str | None] = mapped_column("check_job", String(36), index=True)


KEPT_TABLES: tuple[type[Kept], ...] = (Driver, Motion)
"""All tables of what users keep."""
