"""The table of figures that only grow."""

from __future__ import annotations

from sqlalchemy import Float, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base


class Counter(Base):
    """One figure. It outlives the jobs and files that it counts, and the processes that count them."""

    __tablename__ = "counters"

    name: Mapped[str] = mapped_column(String(64), primary_key=True)
    labels: Mapped[str] = mapped_column(String(512), primary_key=True)
    """The values of its labels as a JSON list, in the order that `counters` gives them."""
    value: Mapped[float] = mapped_column(Float)
