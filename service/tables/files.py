"""The table of uploaded files."""

from __future__ import annotations

from sqlalchemy import ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base
from service.tables.stored import InStorage


class File(InStorage, Base):
    """An uploaded file. It lies in the storage under its id; its name is only shown."""

    __tablename__ = "files"

    owner: Mapped[str] = mapped_column(ForeignKey("keys.id"), index=True)
    name: Mapped[str] = mapped_column(String(255))
