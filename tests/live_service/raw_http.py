"""HTTP of bare sockets: what no client library would send, and answers byte by byte."""

from __future__ import annotations

import json
import socket
from typing import Any

from running import Running


def connect(running: Running, sent: bytes = b"") -> socket.socket:
    """A connection over which this was sent. What does not come within a minute never comes."""
    connection = socket.create_connection((running.client.base_url.host, running.client.base_url.port), timeout=60)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    connection.sendall(sent)
    return connection


def request(method: str, path: str, body: bytes = b"", **headers: str) -> bytes:
    """A request; `Host` and the body's length are added where they are not given."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    lengths = {"Content-Length", "Transfer-Encoding"}
    given = {"Host": "localhost"} | ({"Content-Length": str(len(body))} if body and not lengths & set(named) else {})
    head = "".join(f"{name}: {value}\r\n" for name, value in (given | named).items())
    return f"{method} {path} HTTP/1.1\r\n{head}\r\n".encode() + body


def until_closed(connection: socket.socket) -> bytes:
    """All that still comes; a reset ends it too."""
    came = b""
    try:
        while piece := connection.recv(65536):
            came += piece
    except ConnectionResetError:
        pass
    connection.close()
    return came


def problem(answer: bytes) -> tuple[int, str]:
    """The status and the code of an answer that is a problem document."""
    head, _, body = answer.partition(b"\r\n\r\n")
    assert b"content-type: application/problem+json" in head.lower(), answer[:2000]
    document: dict[str, Any] = json.loads(body)
    assert document["status"] == int(head.split()[1])
    return document["status"], document["code"]
