"""Changing a job in SQL although the database cannot be reached or written for a while (a restart, a lock, a full disk)."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

import structlog
from sqlalchemy.exc import SQLAlchemyError

T = TypeVar("T")

DATABASE_RETRY_SECONDS = 1.0


def retry_db(change: Callable[[], T], seconds: float) -> T:
    """Do it, again and again for so many seconds while the database refuses. Raises SQLAlchemyError after that.

    `change` may be done although it looked as if it was not: the connection can break between a commit and its answer.
    """
    deadline = time.monotonic() + seconds
    while True:
        try:
            return change()
        except SQLAlchemyError as error:
            if time.monotonic() > deadline:
                raise
            structlog.get_logger().warning("database_not_written", reason=str(error).splitlines()[0])
            time.sleep(DATABASE_RETRY_SECONDS)
