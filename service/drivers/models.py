"""The table of the user's own drivers."""

from __future__ import annotations

from sqlalchemy import String
from sqlalchemy.orm import Mapped, mapped_column

from service.kept.models import Kept


class Driver(Kept):
    """A driving video that a user keeps under a name."""

    __tablename__ = "drivers"

    look_job: Mapped[str | None] = mapped_column("moments_job", String(36), index=True)
