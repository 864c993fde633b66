"""What all tables have in common: their ancestor, the types of their columns, and the clock that they go by."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import DateTime, Dialect, Float, String, TypeDecorator, literal
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.orm import DeclarativeBase
from sqlalchemy.sql.functions import GenericFunction

from service.vault import STORED_CHARACTERS, Secret

SET_BACK_SECONDS = 1800.0
"""What lies further ahead (leases are far shorter) was written before the clock was set back."""


class Base(DeclarativeBase):
    """The tables' common ancestor."""


class UTCDateTime(TypeDecorator[datetime]):
    """A moment in UTC, on databases with and without time zones."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        return None if value is None else value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


class Sealed(TypeDecorator[Secret]):
    """A secret, kept as the vault of the database says (`Database` gives it to its dialect)."""

    impl = String(STORED_CHARACTERS)
    cache_ok = True

    def process_bind_param(self, value: Secret | None, dialect: Dialect) -> str | None:
        return None if value is None else dialect.galatea_vault.seal(value.reveal())  # type: ignore[attr-defined]

    def process_result_value(self, value: str | None, dialect: Dialect) -> Secret | None:
        return None if value is None else dialect.galatea_vault.open(value)  # type: ignore[attr-defined]


class moment_in(GenericFunction[datetime]):
    """`moment_in(seconds)`: the database's own now, and so many seconds on (or back).

    What several machines compare, such as the end of a lease, is measured by this one clock and never by theirs.
    """

    type = UTCDateTime()
    inherit_cache = True

    def __init__(self, seconds: float = 0.0):
        super().__init__(literal(float(seconds), Float))


@compiles(moment_in, "postgresql")
def _moment_on_postgresql(element: moment_in, compiler: Any, **keywords: Any) -> str:
    return f"(clock_timestamp() + make_interval(secs => {compiler.process(element.clauses, **keywords)}))"


@compiles(moment_in, "sqlite")
def _moment_on_sqlite(element: moment_in, compiler: Any, **keywords: Any) -> str:
    seconds = compiler.process(element.clauses, **keywords)
    return f"strftime('%Y-%m-%d %H:%M:%f000', 'now', ({seconds}) || ' seconds')"
