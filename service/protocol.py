"""HTTP/1.1 as uvicorn speaks it by h11, whose own refusals are problem documents too, and in turns with everybody."""

from __future__ import annotations

import asyncio
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from service.problems import Problem

SLICE_BYTES = 1 << 13
"""As much is read in one go: what comes in chunks of one byte takes a thousand times as long as it is worth."""


class Protocol(H11Protocol):
    """Answers what is no request, or one whose head has no end, as the service answers every error."""

    def __init__(self, *arguments: Any, **more: Any):
        super().__init__(*arguments, **more)
        self._backlog = bytearray()
        self._held_back = False

    def data_received(self, data: bytes) -> None:
        """Read what came, a slice at a time: the others have their turn in between, and no more comes meanwhile."""
        self._backlog += data
        if not self._held_back:
            self._read_slice()

    def connection_lost(self, exc: Exception | None) -> None:
        self._backlog.clear()
        super().connection_lost(exc)

    def _read_slice(self) -> None:
        piece = bytes(self._backlog[:SLICE_BYTES])
        del self._backlog[:SLICE_BYTES]
        if piece:
            super().data_received(piece)
        if self.transport.is_closing():
            self._backlog.clear()
        elif self._backlog:
            self._held_back = True
            self.transport.pause_reading()
            asyncio.get_running_loop().call_soon(self._read_slice)
        elif self._held_back:
            self._held_back = False
            if not self.flow.read_paused:
                self.transport.resume_reading()

    def send_400_response(self, msg: str) -> None:
        detail = "This is no HTTP/1.1 request, or its address and headers do not end within 64 KB."
        answer = Problem(400, "malformed_request", detail, headers={"Connection": "close"}).response()
        for event in (
            h11.Response(status_code=answer.status_code, headers=answer.raw_headers),
            h11.Data(data=answer.body),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()
