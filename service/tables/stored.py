"""What a row says of its file in the storage: all that is needed to send it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import BigInteger, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import UTCDateTime


@dataclass(frozen=True)
class Stored:
    """Something that can be sent."""

    key: str
    name: str
    content_type: str
    size: int
    sha256: str
    modified: datetime


class InStorage:
    """The columns of a table whose rows lie in the storage, each under its table's name and its id."""

    __tablename__: str
    name: Mapped[str]

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    content_type: Mapped[str] = mapped_column(String(100))
    size: Mapped[int] = mapped_column(BigInteger)
    sha256: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)

    @property
    def key(self) -> str:
        return f"{self.__tablename__}/{self.id}"

    @property
    def stored(self) -> Stored:
        """How it is sent."""
        return Stored(self.key, self.name, self.content_type, self.size, self.sha256, self.created_at)
