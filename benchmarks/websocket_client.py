"""A WebSocket client that blocks, as small as can be (RFC 6455): for benchmarks and tests, against a service of one's own."""

from __future__ import annotations

import base64
import os
import socket
from typing import Self

from service.connections.websocket_frames import (
    BINARY,
    CLOSE,
    MAX_CONTROL_BYTES,
    PING,
    TEXT,
    accept_key,
    masked,
)


class Refused(Exception):
    """The handshake was answered otherwise: `status`, and the answer's `body`."""

    def __init__(self, status: int, body: str):
        super().__init__(f"{status} {body}")
        self.status, self.body = status, body


class Closed(Exception):
    """The other side said goodbye, with a `code`."""

    def __init__(self, code: int, reason: str):
        super().__init__(f"{code} {reason}")
        self.code, self.reason = code, reason


class WebSocket:
    """A connection to ws://host:port/path; a context manager."""

    def __init__(self, host: str, port: int, path: str, seconds: float = 20.0, **headers: str):
        """`headers` go with the handshake, `_` in their names standing for `-`. Raises `Refused`."""
        self._line = socket.create_connection((host, port), seconds)
        self._line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._file = self._line.makefile("rb")
        key = base64.b64encode(os.urandom(16))
        given = {"Host": f"{host}:{port}", "Upgrade": "websocket", "Connection": "Upgrade"}
        given |= {"Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": key.decode()}
        given |= {name.replace("_", "-"): value for name, value in headers.items()}
        lines = [f"GET {path} HTTP/1.1", *(f"{name}: {value}" for name, value in given.items()), "", ""]
        self._line.sendall("\r\n".join(lines).encode())
        status = int(self._file.readline().split()[1])
        answered = {}
        while (line := self._file.readline().strip()) != b"":
            name, _, value = line.partition(b":")
            answered[name.lower()] = value.strip()
        if status != 101:
            body = self._file.read(int(answered.get(b"content-length", b"0"))).decode()
            self.close()
            raise Refused(status, body)
        assert answered[b"sec-websocket-accept"] == accept_key(key)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the line, without a goodbye."""
        self._file.close()
        self._line.close()

    def send(self, message: str | bytes) -> None:
        """Send a text or bytes."""
        data = message.encode() if isinstance(message, str) else message
        self.send_frame(0x80 | (TEXT if isinstance(message, str) else BINARY), data)

    def send_frame(self, first: int, data: bytes) -> None:
        """Send one frame, whose first byte is given."""
        key, length = os.urandom(4), len(data)
        if length <= MAX_CONTROL_BYTES:
            head = bytes([first, 0x80 | length])
        elif length < 1 << 16:
            head = bytes([first, 0xFE]) + length.to_bytes(2, "big")
        else:
            head = bytes([first, 0xFF]) + length.to_bytes(8, "big")
        self._line.sendall(head + key + masked(data, key))

    def receive(self) -> str | bytes:
        """The next message. Raises `Closed`, and `TimeoutError`."""
        while True:
            first, length = self._file.read(2) or b"\0\0"
            if not first:
                raise Closed(1006, "the line is broken")
            if length == 126:
                length = int.from_bytes(self._file.read(2), "big")
            elif length == 127:
                length = int.from_bytes(self._file.read(8), "big")
            data = self._file.read(length)
            opcode = first & 0x0F
            if opcode == CLOSE:
                self.send_frame(0x80 | CLOSE, data[:2])
                raise Closed(int.from_bytes(data[:2], "big"), data[2:].decode())
            if opcode in (TEXT, BINARY):
                return data.decode() if opcode == TEXT else data
            assert opcode >= PING
