"""The table of the user's own motions."""

from __future__ import annotations

from sqlalchemy import String
from sqlalchemy.orm import Mapped, mapped_column

from service.kept.models import Kept


class Motion(Kept):
    """A motion file that a user keeps under a name."""

    __tablename__ = "motions"

    look_job: Mapped[str | None] = mapped_column("check_job", String(36), index=True)
