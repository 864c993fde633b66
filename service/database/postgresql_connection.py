"""A connection of pg8000's whose every breaking off is a fault of the database.

pg8000 lets an `OSError` through where the first byte of an answer is read from a connection that was reset, and SQLAlchemy passes on as it is what no
DB-API error is: a worker would take it for a file that cannot be written.
"""

from __future__ import annotations

from typing import Any

from pg8000 import Connection, InterfaceError


class PostgresqlConnection(Connection):  # type: ignore[misc]  # pg8000 has no types
    """Raises pg8000's InterfaceError, "network error", wherever the network fails it, also while it is opened."""

    def __init__(self, *positional: Any, **named: Any):
        try:
            super().__init__(*positional, **named)
        except OSError as error:
            raise InterfaceError(f"network error: {error}") from error

    def handle_messages(self, context: Any) -> None:
        try:
            super().handle_messages(context)
        except OSError as error:
            raise InterfaceError(f"network error: {error}") from error
