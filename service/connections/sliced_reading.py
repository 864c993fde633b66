"""HTTP/1.1 as uvicorn speaks it by h11, read a slice at a time, so that everybody has a turn."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from uvicorn.protocols.http.flow_control import FlowControl
from uvicorn.protocols.http.h11_impl import H11Protocol

READ_SLICE_BYTES = 1 << 15
"""How much of what came is read in one go."""
FINE_SLICE_BYTES = 1 << 12
"""How much of a body in chunks is read in one go: where each has one byte, it takes a thousand times as long."""


class _SlicedFlow(FlowControl):
    """Lets the line bring more only when what it brought before was read: whoever takes a piece asks for more, and a piece
    is a small part of what one look at the line brings."""

    def __init__(self, transport: asyncio.Transport, go_on: Callable[[], None]):
        super().__init__(transport)
        self._go_on = go_on

    def resume_reading(self) -> None:
        if self.read_paused:
            self.read_paused = False
            self._go_on()


class SlicedReading(H11Protocol):
    """Reads what came a slice at a time."""

    def __init__(self, *arguments: Any, **more: Any):
        super().__init__(*arguments, **more)
        self._backlog = bytearray()
        self._held_back = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.flow = _SlicedFlow(transport, self._go_on)

    def data_received(self, data: bytes) -> None:
        """Read what came, a slice at a time: the others have their turn in between, and no more comes meanwhile."""
        self._backlog += data
        if not self._held_back:
            self._read_slice()

    def connection_lost(self, exc: Exception | None) -> None:
        self._backlog.clear()
        super().connection_lost(exc)

    def _go_on(self) -> None:
        if self._held_back:
            asyncio.get_running_loop().call_soon(self._read_slice)
        else:
            self.transport.resume_reading()

    def _read_slice(self) -> None:
        if self.transport.is_closing():  # whoever was refused is not served as well
            self._backlog.clear()
            return
        if self._held_back and self.flow.read_paused:
            return  # until what was read is taken
        size = FINE_SLICE_BYTES if self._in_chunks() else READ_SLICE_BYTES
        piece = bytes(self._backlog[:size])
        del self._backlog[:size]
        if piece:
            super().data_received(piece)
        if self.transport.is_closing():
            self._backlog.clear()
        elif self._backlog:
            self._held_back = True
            self.transport.pause_reading()
            if not self.flow.read_paused:
                asyncio.get_running_loop().call_soon(self._read_slice)
        elif self._held_back:
            self._held_back = False
            if not self.flow.read_paused:
                self.transport.resume_reading()

    def _in_chunks(self) -> bool:
        """Whether the request under way comes in chunks, or none has come yet."""
        return self.headers is None or any(name == b"transfer-encoding" for name, _ in self.headers)
