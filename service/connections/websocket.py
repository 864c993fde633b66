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
from websockets.frames import CloseCode, Frame, Opcode
from websockets.protocol import OPEN, Protocol, Side
from websockets.utils import accept_key

from service.connections.transport import Transport
from service.http import browser
from service.problems import Problem, phrase

MAX_WEBSOCKET_MESSAGE_BYTES = 8 << 20
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
        self._protocol = Protocol(Side.SERVER, max_size=MAX_WEBSOCKET_MESSAGE_BYTES)
        self._opcode, self._parts = Opcode.TEXT, bytearray()  # of the message that comes in
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
        self._protocol.receive_data(data)
        for frame in self._protocol.events_received():
            if self._state == "open" and isinstance(frame, Frame):
                self._take(frame)
        self._flush()
        if (
            self._state == "open" and self._protocol.state is not OPEN
        ):  # the other side's goodbye, or what breaks the protocol
            said = self._protocol.close_rcvd or self._protocol.close_sent
            self._disconnected(int(said.code) if said is not None else CloseCode.ABNORMAL_CLOSURE)
            self._state = "closing"
            self._writable.set()
        if self._queue.qsize() >= MAX_WAITING:
            self._transport.pause_reading()

    def connection_lost(self, error: Exception | None) -> None:
        self._disconnected(CloseCode.ABNORMAL_CLOSURE)
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
            self._end(CloseCode.SERVICE_RESTART, "the service ends")
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
                self._end(CloseCode.INTERNAL_ERROR, "internal error")
        finally:
            if self._state == "asked":
                self._refuse(Problem(500, "internal_error", "The service met a fault of the program."))
            elif self._state == "open":
                self._end(CloseCode.NORMAL_CLOSURE, "")

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
            self._end(message.get("code", CloseCode.NORMAL_CLOSURE), message.get("reason") or "")

    async def _write(self, message: dict[str, Any]) -> None:
        await self._writable.wait()
        if self._state != "open":
            return
        data = message.get("bytes")
        if data is None:
            self._protocol.send_text(message["text"].encode())
        else:
            self._protocol.send_binary(data)
        self._flush()

    def _accept(self) -> None:
        answer = accept_key(dict(self._http["headers"])[b"sec-websocket-key"].decode()).encode()
        head = (b"HTTP/1.1 101 Switching Protocols", b"Upgrade: websocket", b"Connection: Upgrade")
        self._transport.write(b"\r\n".join((*head, b"Sec-WebSocket-Accept: " + answer, b"", b"")))
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

    def _take(self, frame: Frame) -> None:
        """Put a message together; pings and goodbyes are answered already."""
        if frame.opcode in (Opcode.TEXT, Opcode.BINARY):
            self._opcode, self._parts = frame.opcode, bytearray(frame.data)
        elif frame.opcode is Opcode.CONT:
            self._parts += bytes(frame.data)
        if frame.opcode not in (Opcode.TEXT, Opcode.BINARY, Opcode.CONT) or not frame.fin:
            return
        content: dict[str, Any] = {"bytes": bytes(self._parts)}
        if self._opcode is Opcode.TEXT:
            try:
                content = {"text": self._parts.decode()}
            except UnicodeDecodeError:
                self._end(CloseCode.INVALID_DATA, "texts are UTF-8")
                return
        self._queue.put_nowait({"type": "websocket.receive", **content})

    def _flush(self) -> None:
        """Write what the protocol has to say, and end the line where it ends."""
        for data in self._protocol.data_to_send():
            if data:
                self._transport.write(data)
            else:
                self._state = "closed" if self._state == "closing" else self._state
                self._transport.close()

    def _end(self, code: int, reason: str) -> None:
        """Say goodbye, and wait a moment for the answer."""
        if self._state != "open":
            return
        self._protocol.send_close(code, reason.encode()[:120].decode(errors="ignore"))
        self._flush()
        self._state = "closing"
        self._disconnected(code)
        self._writable.set()
        self._transport.resume_reading()
        asyncio.get_running_loop().call_later(CLOSE_SECONDS, self._transport.close)

    def _disconnected(self, code: int) -> None:
        self._queue.put_nowait({"type": "websocket.disconnect", "code": code})

    def _give_up(self) -> None:
        self._state = "closed"
        self._disconnected(CloseCode.PROTOCOL_ERROR)
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
