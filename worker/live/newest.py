"""A place for one thing: what comes takes the place of what nobody took, so that whoever is late goes on with the newest."""

from __future__ import annotations

import threading
from typing import Generic, TypeVar

T = TypeVar("T")


class Newest(Generic[T]):
    """Between two threads."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._thing: T | None = None
        self._closed = False

    def put(self, thing: T) -> None:
        """Lay something there, in place of what lies there."""
        with self._changed:
            self._thing = thing
            self._changed.notify()

    def take(self) -> T | None:
        """What lies there, waiting for it; None once it is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._thing is not None or self._closed)
            thing, self._thing = self._thing, None
            return None if self._closed else thing

    def close(self) -> None:
        """Nothing more comes, and what lies there is not wanted any more."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
