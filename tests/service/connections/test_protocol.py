"""However much comes over a line at once, and however finely cut, the others have their turn in between."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from uvicorn.server import ServerState

from service.connections.connection_limit import ConnectionLimit
from service.connections.protocol import Config, Protocol
from service.connections.sliced_reading import FINE_SLICE_BYTES, READ_SLICE_BYTES

Answer = tuple[bytes, list[str]]

BODY = bytes(range(251)) * 1000
HEAD = b"POST / HTTP/1.1\r\nHost: localhost\r\n"


def framed(size: int) -> bytes:
    pieces = [BODY[i : i + size] for i in range(0, len(BODY), size)]
    return b"".join(b"%x\r\n%s\r\n" % (len(piece), piece) for piece in pieces) + b"0\r\n\r\n"


async def taken(sent: bytes, requests: int) -> list[list[bytes]]:
    """The bodies of so many requests that come over one line in one go, each in the pieces in which it was given."""
    bodies: list[list[bytes]] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        pieces: list[bytes] = []
        bodies.append(pieces)
        more = True
        while more:
            message = await receive()
            pieces.append(message["body"])
            more = message["more_body"]
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body", "body": b""})

    config = Config(app, ConnectionLimit(10), 60, 60, ws="none", lifespan="off", log_config=None)
    server = await asyncio.get_running_loop().create_server(lambda: Protocol(config, ServerState(), {}), "127.0.0.1", 0)
    async with server:
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
        writer.write(sent)
        for _ in range(requests):
            assert (await reader.readuntil(b"\r\n\r\n")).startswith(b"HTTP/1.1 204")
        writer.close()
        await writer.wait_closed()
    return bodies


@pytest.mark.parametrize("size", [1, 7, 1000, len(BODY)])
def test_a_body_in_chunks_of_any_size(size: int) -> None:
    (pieces,) = asyncio.run(taken(HEAD + b"Transfer-Encoding: chunked\r\n\r\n" + framed(size), 1))
    assert b"".join(pieces) == BODY
    assert max(map(len, pieces)) <= 2 * FINE_SLICE_BYTES


def test_requests_that_come_one_behind_the_other() -> None:
    one = HEAD + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY
    two = HEAD + b"Transfer-Encoding: chunked\r\n\r\n" + framed(500)
    bodies = asyncio.run(taken(one + two + one, 3))
    assert [b"".join(pieces) for pieces in bodies] == [BODY] * 3
    assert max(len(piece) for pieces in bodies for piece in pieces) <= 2 * READ_SLICE_BYTES


async def refused(between: Any) -> Answer:
    """What is answered to whoever sends a request of which `between(protocol, writer)` decides what becomes; and what
    went wrong meanwhile."""
    faults: list[str] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, told: faults.append(str(told)))
    protocols: list[Protocol] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        faults.extend(["it is worked on"] if scope["path"] == "/refused" else [])
        await send({"type": "http.response.start", "status": 415, "headers": [(b"content-length", b"0")]})
        await send({"type": "http.response.body", "body": b""})

    config = Config(app, ConnectionLimit(10), 60, 60, ws="none", lifespan="off", log_config=None)

    def accept() -> Protocol:
        protocols.append(Protocol(config, ServerState(), {}))
        return protocols[-1]

    server = await asyncio.get_running_loop().create_server(accept, "127.0.0.1", 0)
    async with server:
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
        while not protocols:
            await asyncio.sleep(0)
        answer = await between(protocols[0], reader, writer)
        answer += await reader.read()
        writer.close()
        await writer.wait_closed()
    return answer, faults


def test_a_body_that_goes_wrong_after_it_was_answered_is_no_fault() -> None:
    async def between(_: Protocol, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bytes:
        writer.write(HEAD + b"Transfer-Encoding: chunked\r\n\r\n1\r\na\r\n")
        answer = await reader.readuntil(b"\r\n\r\n")
        writer.write(b"no length\r\n")
        return answer

    answer, faults = asyncio.run(refused(between))
    assert answer.startswith(b"HTTP/1.1 415") and answer.count(b"HTTP/1.1") == 1
    assert faults == []


def test_who_was_turned_away_in_mid_request_is_not_served_as_well() -> None:
    async def between(protocol: Protocol, *_: Any) -> bytes:
        head = b"POST /refused HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * int(1.5 * FINE_SLICE_BYTES)
        protocol.data_received(head + b"\r\nContent-Length: 0\r\n\r\n")
        protocol.make_room()  # the second slice has not had its turn
        return b""

    answer, faults = asyncio.run(refused(between))
    assert answer.startswith(b"HTTP/1.1 503") and answer.count(b"HTTP/1.1") == 1
    assert faults == []
