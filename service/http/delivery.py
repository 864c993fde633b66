"""Sending what is stored: whole, in parts, or not at all where the client has it already."""

from __future__ import annotations

import secrets
from collections.abc import AsyncIterator, Callable
from email.utils import format_datetime
from typing import Any, TypeVar
from urllib.parse import quote

from fastapi import APIRouter, Request
from starlette.responses import Response, StreamingResponse
from starlette.types import Send

from service.http import browser
from service.http.ranges import Unsatisfiable, not_modified, parse_ranges, range_applies
from service.problems import Problem, responses, unavailable
from service.storage.files import Storage, StorageUnavailable
from service.tables.stored import Stored

Endpoint = TypeVar("Endpoint", bound=Callable[..., Any])

DELIVERY_RESPONSES: dict[int | str, dict[str, Any]] = {304: {"description": "Not modified"}, **responses(404, 416)}
"""What `deliver` may answer beside the whole, for the OpenAPI document."""

DELIVERED_IN_PARTS: dict[int | str, dict[str, Any]] = {206: {"description": "The asked parts"}, **DELIVERY_RESPONSES}
"""What `deliver` may answer beside the whole where ranges are often asked for, for the OpenAPI document."""


def stored_file(
    path: str, router: APIRouter, operation_id: str, answers: dict[int | str, dict[str, Any]]
) -> Callable[[Endpoint], Endpoint]:
    """Register a function that answers GET requests by `deliver`, and HEAD requests for the same."""

    def register(endpoint: Endpoint) -> Endpoint:
        router.get(path, operation_id=operation_id, response_class=Response, responses=answers)(endpoint)
        router.head(path, include_in_schema=False)(endpoint)
        return endpoint

    return register


def deliver(stored: Stored, storage: Storage, request: Request) -> Response:
    """The answer to a GET or HEAD request."""
    headers, head = request.headers, request.method == "HEAD"
    etag = f'"{stored.sha256}"'
    answer = {
        "ETag": etag,
        "Last-Modified": format_datetime(stored.modified.replace(microsecond=0), usegmt=True),
        "Accept-Ranges": "bytes",
        "Cache-Control": "private, no-cache",
        "Content-Disposition": _disposition(stored.name),
        "Content-Security-Policy": browser.MEDIA_POLICY,
    }
    if not_modified(headers.get("if-none-match"), headers.get("if-modified-since"), etag, stored.modified):
        return Response(status_code=304, headers=answer)
    ranges = None
    if not head and range_applies(headers.get("if-range"), etag, stored.modified):
        try:
            ranges = parse_ranges(headers.get("range"), stored.size)
        except Unsatisfiable:
            raise Problem(
                416,
                "range_not_satisfiable",
                f"The file has {stored.size} bytes.",
                headers={"Content-Range": f"bytes */{stored.size}"},
            ) from None
    if ranges is None:
        answer |= {"Content-Type": stored.content_type, "Content-Length": str(stored.size)}
        return Response(headers=answer) if head else _stream(storage.read(stored.key, 0, stored.size), 200, answer)
    if len(ranges) == 1:
        start, end = ranges[0]
        answer |= {
            "Content-Type": stored.content_type,
            "Content-Length": str(end - start),
            "Content-Range": f"bytes {start}-{end - 1}/{stored.size}",
        }
        return _stream(storage.read(stored.key, start, end), 206, answer)
    return _multipart(stored, storage, ranges, answer)


def _multipart(
    stored: Stored, storage: Storage, ranges: list[tuple[int, int]], answer: dict[str, str]
) -> StreamingResponse:
    boundary = secrets.token_hex(16)
    heads = [
        f"--{boundary}\r\nContent-Type: {stored.content_type}\r\n"
        f"Content-Range: bytes {start}-{end - 1}/{stored.size}\r\n\r\n".encode()
        for start, end in ranges
    ]
    tail = f"--{boundary}--\r\n".encode()
    length = sum(len(h) + end - start + 2 for h, (start, end) in zip(heads, ranges, strict=True)) + len(tail)

    async def parts() -> AsyncIterator[bytes]:
        for head, (start, end) in zip(heads, ranges, strict=True):
            yield head
            async for piece in storage.read(stored.key, start, end):
                yield piece
            yield b"\r\n"
        yield tail

    answer |= {"Content-Type": f"multipart/byteranges; boundary={boundary}", "Content-Length": str(length)}
    return _stream(parts(), 206, answer)


class _Begun(StreamingResponse):
    """Sends nothing before the storage has answered: what cannot be read is a problem, not a body that breaks off."""

    async def stream_response(self, send: Send) -> None:
        pieces = aiter(self.body_iterator)
        try:
            first = await anext(pieces, b"")
        except StorageUnavailable as error:
            raise unavailable() from error

        async def whole() -> AsyncIterator[str | bytes | memoryview]:
            yield first
            async for piece in pieces:
                yield piece

        self.body_iterator = whole()
        await super().stream_response(send)


def _stream(content: AsyncIterator[bytes], status: int, headers: dict[str, str]) -> StreamingResponse:
    return _Begun(content, status_code=status, headers=headers)


def _disposition(name: str) -> str:
    plain = "".join(c if c.isascii() and c.isprintable() and c not in '"\\%' else "_" for c in name)
    return f"inline; filename=\"{plain}\"; filename*=UTF-8''{quote(name, safe='')}"
