"""Content codings (RFC 9110, sections 8.4 and 12.5.3): which a client takes, and answers of the API by one of them."""

from __future__ import annotations

import gzip
import re

from anyio.to_thread import run_sync
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

MIN_GZIP_BYTES = 1000
"""A shorter text is sent as it is."""

THREADED_GZIP_BYTES = 50_000
"""A longer text is compressed in a thread."""

GZIP_LEVEL = 5
TEXT_TYPES = ("application/json", "application/problem+json", "text/plain")


def accepts(header: str | None, coding: str) -> bool:
    """Whether an `Accept-Encoding` header names a coding, and not to refuse it."""
    for part in (header or "").lower().split(","):
        name, _, parameters = part.partition(";")
        if name.strip() == coding:
            return re.fullmatch(r"\s*q\s*=\s*0(\.0*)?\s*", parameters) is None
    return False


class Compressed:
    """Sends texts that are sent whole by gzip, to those who take it. Streams and media go as they are."""

    def __init__(self, app: ASGIApp):
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        taken = accepts(Headers(scope=scope).get("accept-encoding"), "gzip")
        held: Message | None = None

        async def send_compressed(message: Message) -> None:
            nonlocal held
            if message["type"] == "http.response.start" and _is_text(message):
                MutableHeaders(scope=message).add_vary_header("Accept-Encoding")
                held = message
                return
            if held is not None:
                start, held = held, None
                if taken and not message.get("more_body", False) and len(message.get("body", b"")) >= MIN_GZIP_BYTES:
                    message = {**message, "body": await _gzipped(message["body"])}
                    headers = MutableHeaders(scope=start)
                    headers["Content-Encoding"] = "gzip"
                    headers["Content-Length"] = str(len(message["body"]))
                await send(start)
            await send(message)

        await self.app(scope, receive, send_compressed)


def _is_text(start: Message) -> bool:
    headers = Headers(raw=start["headers"])
    return headers.get("content-type", "").startswith(TEXT_TYPES) and not {"content-encoding", "etag"} & set(headers)


async def _gzipped(body: bytes) -> bytes:
    if len(body) < THREADED_GZIP_BYTES:
        return gzip.compress(body, GZIP_LEVEL, mtime=0)
    return await run_sync(lambda: gzip.compress(body, GZIP_LEVEL, mtime=0))
