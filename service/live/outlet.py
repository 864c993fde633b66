"""Where a live portrait goes: the newest frame and all events, for one who looks. What is not taken in time is never sent."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from typing import Any

MAX_EVENTS = 100
"""Events that wait, at most: whoever takes none learns of the last ones."""


class Outlet:
    """One who looks."""

    def __init__(self) -> None:
        self.taken_at = time.monotonic()
        """When a frame was last taken."""
        self._frame: bytes | None = None
        self._events: deque[dict[str, Any]] = deque(maxlen=MAX_EVENTS)
        self._something = asyncio.Event()

    def show(self, frame: bytes) -> None:
        """The newest frame, in place of one that was not taken."""
        self._frame = frame
        self._something.set()

    def tell(self, event: dict[str, Any]) -> None:
        """Something happened."""
        self._events.append(event)
        self._something.set()

    async def take(self) -> dict[str, Any] | bytes:
        """The next event, or else the newest frame."""
        while True:
            if self._events:
                return self._events.popleft()
            if (frame := self._frame) is not None:
                self._frame, self.taken_at = None, time.monotonic()
                return frame
            self._something.clear()
            await self._something.wait()
