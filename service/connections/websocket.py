"""A connection that became a WebSocket (RFC 6455), as ASGI speaks of it. Everything is refused before the handshake is
answered, by problem documents like those of any request.

It is read no further than what is taken, and given up when nothing is taken from it.
"""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Callable
from http import HTTPStatus
from typing import Any, cast

import structlog
from starlette.types import ASGIApp, Scope

from service.connections.transport import Transport
from service.connections.websocket_frames import (
    BINARY,
    CLOSE,
    FAILED,
    NO_STATUS,
    NORMAL,
    PING,
    PONG,
    PROTOCOL_ERROR,
    RESTART,
    TEXT,
    Message,
    MessageReader,
    Violation,
    accept_key,
    encoded,
)
from service.http import browser
from service.problems import Problem, phrase

MAX_MESSAGE_BYTES = 8 << 20
"""Of a message that comes in; who takes them says what they may be."""
MAX_WAITING = 4
"""Messages that wait to be taken before no more is read."""
CLOSE_SECONDS = 2.0
"""How long the other side may take to say goodbye."""


class WebSocketConnection(asyncio.Protocol):
    """The life of one WebSocket, from the request that asks for it on."""

    def __init__(self, app: ASGIApp, scope: Scope, transport: Transport, lost: Callable[[Exception | None], None]):
        """`scope` is that of the HTTP request; `lost` is told when the connection is."""
        self._app, self._http, self._transport, self._lost = app, scope, transport, lost
        self._reader = MessageReader(MAX_MESSAGE_BYTES)
        self._queue: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._state = "asked"  # then open, closing, closed
        self._writable = asyncio.Event()
        self._writable.set()
        self._status = 403
        self._headers: list[tuple[bytes, bytes]] = []

    def begin(self) -> asyncio.Task[None]:
        """Have the application answer."""
        return asyncio.get_running_loop().create_task(self._run())

    # What the line tells.

    def data_received(self, data: bytes) -> None:
        if self._state not in ("open", "closing"):
            if self._state == "asked":
                self._give_up()  # nobody may speak before the handshake is answered
            return
        try:
            for message in self._reader.feed(data):
                self._take(message)
        except Violation as violation:
            self._end(violation.code, violation.reason)
        if self._queue.qsize() >= MAX_WAITING:
            self._transport.pause_reading()

    def connection_lost(self, error: Exception | None) -> None:
        self._disconnected(1006)
        self._state = "closed"
        self._writable.set()
        self._lost(error)

    def pause_writing(self) -> None:
        self._writable.clear()
        self._transport.watch_sending()

    def resume_writing(self) -> None:
        self._writable.set()
        self._transport.rest()

    def shutdown(self) -> None:
        """End with the service."""
        if self._state == "open":
            self._end(RESTART, "the service ends")
        else:
            self._transport.close()

    # What the application is told, and says.

    async def _run(self) -> None:
        scope = {
            **self._http,
            "type": "websocket",
            "scheme": "wss" if self._http["scheme"] == "https" else "ws",
            "subprotocols": [],
            "extensions": {"websocket.http.response": {}},
        }
        del scope["method"]
        problem = _wrong_handshake(self._http)
        try:
            if problem is not None:
                self._refuse(problem)
                return
            self._queue.put_nowait({"type": "websocket.connect"})
            await self._app(scope, self._receive, cast(Any, self._send))
        except Exception:
            structlog.get_logger().exception("websocket_failed")
            if self._state == "open":
                self._end(FAILED, "internal error")
        finally:
            if self._state == "asked":
                self._refuse(Problem(500, "internal_error", "The service met a fault of the program."))
            elif self._state == "open":
                self._end(NORMAL, "")

    async def _receive(self) -> dict[str, Any]:
        message = await self._queue.get()
        if self._queue.qsize() < MAX_WAITING and self._state == "open":
            self._transport.resume_reading()
        return message

    async def _send(self, message: dict[str, Any]) -> None:
        kind = message["type"]
        if kind == "websocket.http.response.start":
            self._status, self._headers = message["status"], list(message.get("headers", []))
        elif kind == "websocket.http.response.body":
            self._answer(self._status, self._headers, message.get("body", b""))
        elif kind == "websocket.accept" and self._state == "asked":
            self._accept()
        elif kind == "websocket.send":
            await self._write(message)
        elif kind == "websocket.close" and self._state == "asked":
            self._refuse(Problem(403, "websocket_refused", "The WebSocket was refused."))
        elif kind == "websocket.close" and self._state == "open":
            self._end(message.get("code", NORMAL), message.get("reason") or "")

    async def _write(self, message: dict[str, Any]) -> None:
        await self._writable.wait()
        if self._state != "open":
            return
        data = message.get("bytes")
        self._transport.write(encoded(TEXT, message["text"].encode()) if data is None else encoded(BINARY, data))

    def _accept(self) -> None:
        key = dict(self._http["headers"])[b"sec-websocket-key"]
        head = (b"HTTP/1.1 101 Switching Protocols", b"Upgrade: websocket", b"Connection: Upgrade")
        self._transport.write(b"\r\n".join((*head, b"Sec-WebSocket-Accept: " + accept_key(key), b"", b"")))
        self._state = "open"

    def _refuse(self, problem: Problem) -> None:
        answer = problem.response()
        browser.add_security_headers(answer.headers)
        self._answer(answer.status_code, answer.raw_headers, bytes(answer.body))

    def _answer(self, status: int, headers: list[tuple[bytes, bytes]], body: bytes) -> None:
        """Answer the request as any other, and close."""
        if self._state != "asked":
            return
        lines = [f"HTTP/1.1 {status} {phrase(status)}".encode()]
        lines += [name + b": " + value for name, value in headers if name.lower() != b"connection"]
        self._transport.write(b"\r\n".join((*lines, b"Connection: close", b"", body)))
        self._state = "closed"
        self._transport.close()

    def _take(self, message: Message) -> None:
        if message.opcode == CLOSE:
            if self._state == "open":
                code = int.from_bytes(message.data[:2], "big") if len(message.data) >= 2 else NO_STATUS
                self._transport.write(encoded(CLOSE, message.data[:2]))
                self._disconnected(code)
            self._state = "closed"
            self._transport.close()
        elif self._state == "open" and message.opcode == PING:
            self._transport.write(encoded(PONG, message.data))
        elif self._state == "open" and message.opcode in (TEXT, BINARY):
            content = {"text": message.data.decode()} if message.opcode == TEXT else {"bytes": message.data}
            self._queue.put_nowait({"type": "websocket.receive", **content})

    def _end(self, code: int, reason: str) -> None:
        """Say goodbye, and wait a moment for the answer."""
        if self._state != "open":
            return
        self._transport.write(encoded(CLOSE, code.to_bytes(2, "big") + reason.encode()[:120]))
        self._state = "closing"
        self._disconnected(code)
        self._writable.set()
        self._transport.resume_reading()
        asyncio.get_running_loop().call_later(CLOSE_SECONDS if code != PROTOCOL_ERROR else 0, self._transport.close)

    def _disconnected(self, code: int) -> None:
        self._queue.put_nowait({"type": "websocket.disconnect", "code": code})

    def _give_up(self) -> None:
        self._state = "closed"
        self._disconnected(PROTOCOL_ERROR)
        self._transport.abort()


def _wrong_handshake(scope: Scope) -> Problem | None:
    """Why a request cannot become a WebSocket (section 4.2.1); None if it can."""
    headers = dict(scope["headers"])
    try:
        key = base64.b64decode(headers.get(b"sec-websocket-key", b""), validate=True)
    except ValueError:
        key = b""
    if scope["method"] != "GET" or len(key) != 16:
        return Problem(400, "malformed_request", "This is no WebSocket handshake: GET with a Sec-WebSocket-Key is one.")
    if headers.get(b"sec-websocket-version") != b"13":
        detail = f"{HTTPStatus.UPGRADE_REQUIRED.phrase}: WebSockets are spoken in version 13."
        return Problem(426, "websocket_version", detail, headers={"Sec-WebSocket-Version": "13"})
    return None
