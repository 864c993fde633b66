"""Messages over a WebSocket as a server reads and writes them (RFC 6455, section 5), without extensions.

Strict: clients' frames are masked, no reserved bit is set, control frames are whole and short, texts are UTF-8.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
CONTINUATION = 0
MAX_CONTROL_BYTES = 125
GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
NORMAL, GOING_AWAY, PROTOCOL_ERROR, UNSUPPORTED, NO_STATUS, ABNORMAL = 1000, 1001, 1002, 1003, 1005, 1006
NOT_UTF8, POLICY, TOO_LARGE, FAILED, RESTART = 1007, 1008, 1009, 1011, 1012
"""Codes of a close (section 7.4.1)."""


class Violation(Exception):
    """What came breaks the protocol; `code` is what the connection is closed with."""

    def __init__(self, code: int, reason: str):
        super().__init__(reason)
        self.code, self.reason = code, reason


@dataclass(frozen=True)
class Message:
    """A whole message, or a control frame: `opcode` TEXT, BINARY, CLOSE, PING or PONG, and what it holds."""

    opcode: int
    data: bytes


def accept_key(key: bytes) -> bytes:
    """The answer to a handshake's `Sec-WebSocket-Key` (section 4.2.2)."""
    return base64.b64encode(hashlib.sha1(key + GUID).digest())  # noqa: S324  (the protocol's own, no secret)


def encoded(opcode: int, data: bytes) -> bytes:
    """A server's frame, which is not masked."""
    length = len(data)
    head = bytes([0x80 | opcode])
    if length < 126:
        return head + bytes([length]) + data
    if length < 1 << 16:
        return head + b"\x7e" + length.to_bytes(2, "big") + data
    return head + b"\x7f" + length.to_bytes(8, "big") + data


def masked(data: bytes, key: bytes) -> bytes:
    """Data under a mask of four bytes; the same takes it off (section 5.3)."""
    mask = np.resize(np.frombuffer(key, np.uint8), len(data))
    return (np.frombuffer(data, np.uint8) ^ mask).tobytes()


class MessageReader:
    """Puts messages together from what comes over the line; none holds more than `most` bytes."""

    def __init__(self, most: int):
        self._most = most
        self._buffer = bytearray()
        self._opcode = CONTINUATION
        self._parts = bytearray()

    def feed(self, data: bytes) -> Iterator[Message]:
        """Take in what came; the messages that are whole now. Raises `Violation`."""
        self._buffer += data
        while (frame := self._frame()) is not None:
            fin, opcode, payload = frame
            if opcode >= CLOSE:
                yield Message(opcode, payload)
            elif (message := self._joined(fin, opcode, payload)) is not None:
                yield message

    def _frame(self) -> tuple[bool, int, bytes] | None:
        """The next whole frame: whether it is a message's last, its opcode and its payload."""
        buffer = self._buffer
        if len(buffer) < 2:
            return None
        fin, opcode, length = bool(buffer[0] & 0x80), buffer[0] & 0x0F, buffer[1] & 0x7F
        if buffer[0] & 0x70 or opcode not in (CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG):
            raise Violation(PROTOCOL_ERROR, "reserved bits or opcode")
        if not buffer[1] & 0x80:
            raise Violation(PROTOCOL_ERROR, "a client's frames are masked")
        if opcode >= CLOSE and (not fin or length > MAX_CONTROL_BYTES):
            raise Violation(PROTOCOL_ERROR, "control frames are whole and short")
        wide = {126: 2, 127: 8}.get(length, 0)
        if len(buffer) < 2 + wide:
            return None
        if wide:
            length = int.from_bytes(buffer[2 : 2 + wide], "big")
        if opcode < CLOSE and len(self._parts) + length > self._most:
            raise Violation(TOO_LARGE, f"a message holds {self._most} bytes at most")
        start = 2 + wide + 4
        if len(buffer) < start + length:
            return None
        payload = masked(bytes(buffer[start : start + length]), bytes(buffer[start - 4 : start]))
        del buffer[: start + length]
        return fin, opcode, payload

    def _joined(self, fin: bool, opcode: int, payload: bytes) -> Message | None:
        """A message that is whole with this frame."""
        if (opcode == CONTINUATION) != (self._opcode != CONTINUATION):
            raise Violation(PROTOCOL_ERROR, "parts of messages do not mix")
        if opcode != CONTINUATION:
            self._opcode = opcode
        self._parts += payload
        if not fin:
            return None
        message = Message(self._opcode, bytes(self._parts))
        self._opcode, self._parts = CONTINUATION, bytearray()
        if message.opcode == TEXT:
            try:
                message.data.decode()
            except UnicodeDecodeError:
                raise Violation(NOT_UTF8, "texts are UTF-8") from None
        return message
