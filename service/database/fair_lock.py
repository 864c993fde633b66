"""Taking turns: threads that want the same thing get it in the order in which they came.

A plain lock goes to whoever asks at the right moment; among many, some wait for seconds while others pass by.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager


class FairLock:
    """A lock that is fair."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._taken = False
        self._waiting: deque[threading.Event] = deque()

    @property
    def waiting(self) -> int:
        """How many wait for their turn."""
        with self._lock:
            return len(self._waiting)

    @contextmanager
    def turn(self, timeout: float) -> Iterator[bool]:
        """Wait up to `timeout` seconds for one's turn; it lasts as long as the block. Yields False after a timeout: the
        block then runs without it."""
        mine = self._queue()
        came = mine is None or mine.wait(timeout) or not self._leave(mine)
        try:
            yield came
        finally:
            if came:
                self._pass_on()

    def _queue(self) -> threading.Event | None:
        """Take it at once (None), or what will tell that it is one's turn."""
        with self._lock:
            if not self._taken:
                self._taken = True
                return None
            mine = threading.Event()
            self._waiting.append(mine)
            return mine

    def _leave(self, mine: threading.Event) -> bool:
        """Wait no longer; False if one's turn has come in this moment."""
        with self._lock:
            if mine.is_set():
                return False
            self._waiting.remove(mine)
            return True

    def _pass_on(self) -> None:
        with self._lock:
            if self._waiting:
                self._waiting.popleft().set()
            else:
                self._taken = False
