"""Messages over the line between the service and a live portrait's process."""

from __future__ import annotations

import socket

import pytest

from worker.live.wire import MAX_WIRE_MESSAGE_BYTES, Wire, head, packed


def test_what_is_sent_is_what_comes_until_the_other_side_has_gone() -> None:
    lines = socket.socketpair()
    one, other = map(Wire, lines)
    one.send(b"F", b"\0" * 1000)
    one.send(b"E", b"")
    assert (other.receive(), other.receive()) == ((b"F", b"\0" * 1000), (b"E", b""))
    lines[0].shutdown(socket.SHUT_RDWR)
    assert other.receive() is None


def test_no_message_is_longer_than_one_may_be() -> None:
    with pytest.raises(ValueError, match="too long"):
        head(packed(b"F", b"")[:1] + (MAX_WIRE_MESSAGE_BYTES + 1).to_bytes(4, "big"))
