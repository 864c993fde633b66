"""What comes beside the bodies of requests is bounded: addresses, headers, trailers."""

from __future__ import annotations

import socket

import psutil
import pytest
from running import Running

PIECE = 16 * 1024
MOST = 64 << 20
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
        while sent < MOST:
            connection.sendall(piece)
            sent += len(piece)
    assert api.memory_info().rss - before < 16 << 20
    assert running.client.get("/healthz").status_code == 200


def test_long_headers_within_the_limit_are_read(running: Running) -> None:
    headers = {f"X-{k}": "a" * 2000 for k in range(16)}
    assert running.client.get("/healthz", headers=headers).status_code == 200


def test_bodies_in_small_chunks_are_read(running: Running, picture: bytes) -> None:
    """Their framing is beside the bodies, but bodies come of it."""
    head = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.png"\r\n\r\n'
    body = head + picture + b"\r\n--b--\r\n"
    sent = running.client.post(
        "/v1/files",
        content=(body[k : k + 1] for k in range(len(body))),
        headers={"Content-Type": "multipart/form-data; boundary=b"},
    )
    assert sent.status_code == 201 and sent.json()["size"] == len(picture)
