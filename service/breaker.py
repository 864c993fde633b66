"""A circuit breaker: who is known not to answer is not asked again by those who have no time to wait.

One thread goes on asking, and closes the circuit once it hears an answer.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

import structlog

BREAKER_CHECK_SECONDS = 1.0


class Breaker:
    """Closed as long as all is well; open while nobody answers."""

    def __init__(self, name: str, answers: Callable[[], bool]):
        """`answers` asks, and says within a bounded time whether an answer came."""
        self._name, self._answers = name, answers
        self._lock = threading.Lock()
        self._open = False
        self._over = threading.Event()

    @property
    def open(self) -> bool:
        """Whether asking would be in vain."""
        return self._open

    def trip(self) -> None:
        """Somebody was not answered."""
        with self._lock:
            if self._open or self._over.is_set():
                return
            self._open = True
        structlog.get_logger().warning(f"{self._name}_silent")
        threading.Thread(target=self._ask, name=f"{self._name}-breaker", daemon=True).start()

    def end(self) -> None:
        """Ask no more."""
        self._over.set()

    def _ask(self) -> None:
        while not self._over.is_set():
            if self._answers():
                self._open = False
                structlog.get_logger().info(f"{self._name}_answers")
                return
            self._over.wait(BREAKER_CHECK_SECONDS)
