"""How a connection ends: so that its last answer is read, and although nobody reads it.

Who closes while something still comes in resets the connection, and the other side may lose the answer that it has not
read yet (RFC 9112, section 9.6). So our side is closed first, and what comes is thrown away for a moment.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

PARTING_SECONDS = 2.0
PARTING_BYTES = 16 << 20
"""How many bytes are thrown away before a connection is reset after all."""


class Transport:
    """A transport whose `close` takes care while `careful()`, and which is given up when nothing is taken from it for
    `most` seconds."""

    def __init__(self, transport: asyncio.Transport, careful: Callable[[], bool], most: float):
        self.parting = False
        self._transport = transport
        self._careful = careful
        self._most = most
        self._thrown_away = 0
        self._watch: asyncio.TimerHandle | None = None
        self._unsent = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    def is_closing(self) -> bool:
        return self.parting or self._transport.is_closing()

    def close(self) -> None:
        if self.is_closing():
            self._transport.close()
        elif self._careful():
            self.parting = True
            self._transport.write_eof()
            self._transport.resume_reading()
            asyncio.get_running_loop().call_later(PARTING_SECONDS, self._transport.abort)
        else:
            self._transport.close()
            self.watch_sending()

    def throw_away(self, data: bytes) -> None:
        """What came while parting."""
        self._thrown_away += len(data)
        if self._thrown_away > PARTING_BYTES:
            self._transport.abort()

    def watch_sending(self) -> None:
        """See to it that what is to be sent is taken, until all of it is."""
        self.rest()
        self._unsent = self._transport.get_write_buffer_size()
        if self._unsent:
            self._watch = asyncio.get_running_loop().call_later(self._most, self._look)

    def rest(self) -> None:
        """Nothing is to be watched (any more)."""
        if self._watch is not None:
            self._watch.cancel()
            self._watch = None

    def _look(self) -> None:
        if self._transport.get_write_buffer_size() >= self._unsent:
            self._transport.abort()
        else:
            self.watch_sending()
