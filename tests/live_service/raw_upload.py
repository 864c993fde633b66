"""A tus client of bare sockets, which can drop its line wherever it likes, and media of any length to send by it."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import numpy as np
from running import Running, eventually

TUS = {"Tus-Resumable": "1.0.0"}
PIECE = TUS | {"Content-Type": "application/offset+octet-stream"}
MP4 = b"\x00\x00\x00\x18ftypisom\x00\x00\x02\x00isomiso2"
BLOCK = 1 << 20


class Media:
    """Bytes that begin like an MP4 file and go on at random, the same for the same seed."""

    def __init__(self, size: int, seed: int = 1):
        self.size = size
        self._seed = seed

    def blocks(self, start: int, end: int) -> Iterator[bytes]:
        """The bytes from `start` up to `end`, in pieces."""
        for index in range(start // BLOCK, -(-end // BLOCK)):
            block = np.random.Generator(np.random.SFC64([self._seed, index])).bytes(BLOCK)
            block = MP4 + block[len(MP4) :] if index == 0 else block
            yield block[max(start - index * BLOCK, 0) : end - index * BLOCK]

    def bytes(self, start: int = 0, end: int | None = None) -> bytes:
        return b"".join(self.blocks(start, self.size if end is None else end))


def create(running: Running, length: int | None, **headers: str) -> str:
    """Begin an upload; its address."""
    size = {"Upload-Defer-Length": "1"} if length is None else {"Upload-Length": str(length)}
    response = running.client.post("/v1/uploads", headers=TUS | size | headers)
    assert response.status_code == 201, response.text
    return response.headers["location"]


def add(running: Running, address: str, offset: int, data: bytes, **headers: str) -> httpx.Response:
    """Send one piece."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return running.client.patch(address, content=data, headers=PIECE | {"Upload-Offset": str(offset)} | named)


def standing(running: Running, address: str) -> int:
    """Where the upload stands, as a client that resumes asks."""
    response = running.client.head(address, headers=TUS)
    assert response.status_code == 200, response.status_code
    return int(response.headers["upload-offset"])


def until_taken(running: Running, connection: socket.socket) -> None:
    """Wait until the service has taken all that was sent over an open line."""
    here, there = connection.getsockname()[1], connection.getpeername()[1]

    def on_the_way() -> int:
        """Bytes that either end's system still holds."""
        held = 0
        for row in Path("/proc/net/tcp").read_text().splitlines()[1:]:
            _, local, remote, _, queues, *_ = row.split()
            ports = int(local.rpartition(":")[2], 16), int(remote.rpartition(":")[2], 16)
            sending, receiving = (int(size, 16) for size in queues.split(":"))
            held += sending if ports == (here, there) else receiving if ports == (there, here) else 0
        return held

    eventually(lambda: on_the_way() == 0, "all has come")
    running.client.get("/v1/kinds").raise_for_status()  # and it has had its turn


@contextmanager
def line(running: Running, address: str, offset: int, length: int, **headers: str) -> Iterator[socket.socket]:
    """An open PATCH that announces `length` bytes; leaving the block without having sent them drops the line (reset)."""
    url = running.client.base_url
    connection = socket.create_connection((url.host, url.port), timeout=60)
    named = PIECE | {"Upload-Offset": str(offset), "Content-Length": str(length), "Host": f"{url.host}:{url.port}"}
    named |= {name.replace("_", "-"): value for name, value in headers.items()}
    head = "".join(f"{name}: {value}\r\n" for name, value in named.items())
    try:
        connection.sendall(f"PATCH {address} HTTP/1.1\r\n{head}\r\n".encode())
        yield connection
    finally:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        connection.close()
