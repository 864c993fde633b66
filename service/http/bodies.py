"""Bodies of requests as they come in: counted while they stream, so that what is too long costs no more than its
beginning."""

from __future__ import annotations

from fastapi import Request

from service.problems import Problem

FIELD_BYTES = 1_000_000
"""The most bytes of a JSON body; also of a form's parts that are not files, taken together."""


def announced_bytes(request: Request) -> int:
    """How many bytes a request says it brings; 0 where it does not say."""
    length = request.headers.get("content-length", "")
    return int(length) if length.isascii() and length.isdigit() and len(length) < 20 else 0


async def read(request: Request) -> bytes:
    """The whole body. Raises a 413 problem as soon as it is known to have more than `FIELD_BYTES`."""
    body = bytearray()
    if announced_bytes(request) > FIELD_BYTES:
        raise too_long()
    async for chunk in request.stream():
        body += chunk
        if len(body) > FIELD_BYTES:
            raise too_long()
    return bytes(body)


def too_long() -> Problem:
    return Problem(413, "request_too_large", f"A body that is not a file may have {FIELD_BYTES} bytes at most.")
