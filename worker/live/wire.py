"""How the service and a live portrait's process talk: messages of one byte that says what it is, four of its length, and what
it holds."""

from __future__ import annotations

import socket
import threading

MESSAGE_HEAD_BYTES = 5
MAX_WIRE_MESSAGE_BYTES = 16 << 20


def packed(kind: bytes, data: bytes) -> bytes:
    """A message as it goes over the line."""
    return kind + len(data).to_bytes(4, "big") + data


def head(given: bytes) -> tuple[bytes, int]:
    """What a message's head says: its kind, and its length. Raises `ValueError` where no message is that long."""
    length = int.from_bytes(given[1:MESSAGE_HEAD_BYTES], "big")
    if length > MAX_WIRE_MESSAGE_BYTES:
        raise ValueError("a message is too long")
    return given[:1], length


class Wire:
    """The process's end."""

    def __init__(self, line: socket.socket):
        self._line = line
        self._file = line.makefile("rb")
        self._lock = threading.Lock()

    def send(self, kind: bytes, data: bytes) -> None:
        """Send a message; waits while the other side takes nothing. Raises OSError."""
        with self._lock:
            self._line.sendall(packed(kind, data))

    def receive(self) -> tuple[bytes, bytes] | None:
        """The next message; None once the other side has gone."""
        start = self._file.read(MESSAGE_HEAD_BYTES)
        if len(start) < MESSAGE_HEAD_BYTES:
            return None
        kind, length = head(start)
        data = self._file.read(length)
        return (kind, data) if len(data) == length else None
