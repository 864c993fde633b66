"""Messages over a WebSocket, against the examples of RFC 6455, section 5.7, and what breaks it."""

from __future__ import annotations

import os

import pytest

from service.connections.websocket_frames import (
    BINARY,
    NOT_UTF8,
    PING,
    PROTOCOL_ERROR,
    TEXT,
    TOO_LARGE,
    Message,
    MessageReader,
    Violation,
    accept_key,
    encoded,
    masked,
)

HELLO = bytes.fromhex("818537fa213d7f9f4d5158")


def frame(first: int, data: bytes) -> bytes:
    key, length = os.urandom(4), len(data)
    head = bytes([first, 0x80 | length]) if length < 126 else bytes([first, 0xFE]) + length.to_bytes(2, "big")
    return head + key + masked(data, key)


def read(data: bytes, most: int = 1000) -> list[Message]:
    return list(MessageReader(most).feed(data))


def test_the_handshake_s_answer_is_the_standard_s_own() -> None:
    assert accept_key(b"dGhlIHNhbXBsZSBub25jZQ==") == b"s3pPLMBiTxaQ9kYGzzhZRbK+xOo="


def test_the_standard_s_masked_hello_is_read() -> None:
    assert read(HELLO) == [Message(TEXT, b"Hello")]


def test_a_message_comes_in_parts_with_a_ping_in_between_and_byte_by_byte() -> None:
    reader, line = MessageReader(1000), frame(0x02, b"one ") + frame(0x89, b"?") + frame(0x80, b"two")
    found = [message for k in range(len(line)) for message in reader.feed(line[k : k + 1])]
    assert found == [Message(PING, b"?"), Message(BINARY, b"one two")]


@pytest.mark.parametrize("length", [0, 125, 126, 65535, 65536])
def test_lengths_are_written_as_the_standard_has_them(length: int) -> None:
    data = encoded(BINARY, bytes(length))
    wide = 0 if length < 126 else 2 if length < 65536 else 8
    assert len(data) == 2 + wide + length and data[0] == 0x82
    assert (data[1] if not wide else int.from_bytes(data[2 : 2 + wide], "big")) == length


@pytest.mark.parametrize(
    ("line", "code"),
    [
        (b"\x81\x05Hello", PROTOCOL_ERROR),
        (b"\xc1" + HELLO[1:], PROTOCOL_ERROR),
        (b"\x83" + HELLO[1:], PROTOCOL_ERROR),
        (frame(0x09, b"?"), PROTOCOL_ERROR),
        (frame(0x80, b"of nothing"), PROTOCOL_ERROR),
        (frame(0x01, b"one") + frame(0x81, b"two"), PROTOCOL_ERROR),
        (frame(0x81, b"\xff\xfe"), NOT_UTF8),
        (frame(0x82, bytes(1001)), TOO_LARGE),
        (frame(0x02, bytes(600)) + frame(0x80, bytes(600)), TOO_LARGE),
    ],
    ids=[
        "unmasked",
        "reserved-bit",
        "reserved-opcode",
        "ping-in-parts",
        "part-of-nothing",
        "mixed",
        "not-utf8",
        "large",
        "large-in-parts",
    ],
)
def test_what_breaks_the_protocol_is_told_by_its_code(line: bytes, code: int) -> None:
    with pytest.raises(Violation) as broken:
        read(line)
    assert broken.value.code == code
