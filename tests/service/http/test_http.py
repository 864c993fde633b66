"""HTTP as the service speaks it: what comes beside the bodies of requests is bounded, and no upgrade is needed."""

from __future__ import annotations

import json
import socket
import time

import psutil
import pytest
from raw_http import connect, problem, until_closed
from running import Running

PIECE = 16 * 1024
MAX_BYTES_SENT = 64 << 20
"""Bytes that are sent before the test gives up: more than any buffers on the way hold."""


@pytest.mark.parametrize(
    ("beginning", "piece"),
    [
        (b"GET /", b"a" * PIECE),
        (b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: ", b"a" * PIECE),
        (b"GET / HTTP/1.1\r\nHost: localhost\r\n", b"X-Many: " + b"a" * PIECE + b"\r\n"),
        (
            b"POST /v1/files HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n1\r\na\r\n0\r\n",
            b"X-Trailer: " + b"a" * PIECE + b"\r\n",
        ),
    ],
    ids=["an address", "a header", "many headers", "trailers"],
)
def test_what_never_ends_is_cut_off(running: Running, beginning: bytes, piece: bytes) -> None:
    api = psutil.Process(running.process.pid)
    before, sent = api.memory_info().rss, 0
    address = (running.client.base_url.host, running.client.base_url.port)
    with socket.create_connection(address, timeout=60) as connection, pytest.raises(ConnectionError):
        connection.sendall(beginning)
        while sent < MAX_BYTES_SENT:
            connection.sendall(piece)
            sent += len(piece)
    assert api.memory_info().rss - before < 16 << 20
    assert running.client.get("/healthz").status_code == 200


@pytest.mark.parametrize(
    "sent",
    [
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
        b"GET / HTTP/1.1\r\n\r\n",
        b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: many\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: " + b"a" * (70 << 10),
    ],
    ids=["TLS", "no host", "a length that is none", "a head too long"],
)
def test_what_is_no_request_is_answered_with_a_problem(running: Running, sent: bytes) -> None:
    with socket.create_connection(
        (running.client.base_url.host, running.client.base_url.port), timeout=60
    ) as connection:
        connection.sendall(sent)
        head, body = b"".join(iter(lambda: connection.recv(65536), b"")).split(b"\r\n\r\n", 1)
    assert head.startswith(b"HTTP/1.1 400") and b"content-type: application/problem+json" in head.lower()
    assert json.loads(body)["code"] == "malformed_request"


def test_long_headers_within_the_limit_are_read_however_they_come(running: Running) -> None:
    head = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
    head += "".join(f"X-{k}: {'a' * 2000}\r\n" for k in range(24)) + "\r\n"
    address = (running.client.base_url.host, running.client.base_url.port)
    with socket.create_connection(address, timeout=60) as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for k in range(0, len(head), 4000):
            connection.sendall(head[k : k + 4000].encode())
            time.sleep(0.02)
        assert connection.recv(65536).startswith(b"HTTP/1.1 200")


@pytest.mark.parametrize("protocol", ["h2c", "websocket"])
def test_who_offers_another_protocol_is_answered_in_this_one(running: Running, picture: bytes, protocol: str) -> None:
    """As some client libraries do with every request, those with a body too."""
    headers = {"Connection": "Upgrade, HTTP2-Settings", "Upgrade": protocol, "HTTP2-Settings": ""}
    assert running.client.get("/healthz", headers=headers).json() == {"status": "ok"}
    sent = running.client.post("/v1/files", files={"file": ("a.png", picture)}, headers=headers)
    assert sent.status_code == 201 and sent.json()["size"] == len(picture)


TWO_ENDS = {
    "both a length and chunks": "Content-Length: 5\r\nTransfer-Encoding: chunked",
    "chunks and a length": "Transfer-Encoding: chunked\r\nContent-Length: 5",
    "both, folded": "Content-Length: 5\r\nTransfer-Encoding:\r\n chunked",
    "two lengths": "Content-Length: 0\r\nContent-Length: 5",
    "a list of lengths": "Content-Length: 0, 5",
    "a signed length": "Content-Length: +5",
    "a length in two parts": "Content-Length: 5 5",
    "two codings": "Transfer-Encoding: chunked, identity",
    "a coding after chunks": "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity",
    "another coding": "Transfer-Encoding: identity",
    "nearly chunks": "Transfer-Encoding: xchunked",
    "chunks behind a control character": "Transfer-Encoding: \x0bchunked",
    "a space before the colon": "Transfer-Encoding : chunked",
    "a bare CR": "X-A: a\rTransfer-Encoding: chunked",
    "a NUL": "X-A: a\0b",
    "a header without a name": ": a",
    "two hosts": "Host: example.org",
}


def rejected(running: Running, sent: bytes) -> None:
    """It is answered once, by a refusal, and no second request is found in it."""
    answer = until_closed(connect(running, sent + b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"))
    assert problem(answer) == (400, "malformed_request")
    assert b"connection: close" in answer.lower()


@pytest.mark.parametrize("header", TWO_ENDS.values(), ids=TWO_ENDS.keys())
def test_a_request_whose_end_could_be_seen_elsewhere_is_refused(running: Running, header: str) -> None:
    rejected(running, f"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\n{header}\r\n\r\n0\r\n\r\n".encode("latin-1"))


def test_chunks_are_not_of_http_1_0(running: Running) -> None:
    rejected(running, b"POST /v1/jobs HTTP/1.0\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n")


def test_a_header_is_not_begun_in_the_middle(running: Running) -> None:
    rejected(running, b"GET /healthz HTTP/1.1\r\n X-A: a\r\nHost: localhost\r\n\r\n")


@pytest.mark.parametrize(
    "chunks",
    [
        b"0x5\r\nhello\r\n0\r\n\r\n",
        b"+5\r\nhello\r\n0\r\n\r\n",
        b"5\nhello\n0\n\n",
        b"4\r\nhello\r\n0\r\n\r\n",
        b"F" * 21 + b"\r\nhello\r\n0\r\n\r\n",
    ],
    ids=["hexadecimal twice", "a sign", "LF alone", "longer than it says", "no end of it"],
)
def test_chunks_that_could_end_elsewhere_are_refused(running: Running, chunks: bytes) -> None:
    head = "Host: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked"
    rejected(running, f"POST /v1/jobs HTTP/1.1\r\n{head}\r\n\r\n".encode() + chunks)


@pytest.mark.parametrize(
    "head",
    [
        b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-A: a\r\n b\r\nConnection: close\r\n\r\n",
        b"GET /healthz HTTP/1.1\nHost: localhost\nConnection: close\n\n",
        b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\nContent-Length: 0\r\nConnection: close\r\n\r\n",
    ],
    ids=["a folded line", "LF alone", "the same length twice"],
)
def test_what_can_be_read_in_one_way_only_is_read(running: Running, head: bytes) -> None:
    assert until_closed(connect(running, head)).startswith(b"HTTP/1.1 200")
