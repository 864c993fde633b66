"""Which answers are sent by gzip: texts that are sent whole, and nothing that a coding would make another thing of."""

from __future__ import annotations

import asyncio
import gzip
from collections.abc import AsyncIterator, MutableMapping
from typing import Any

import pytest
from starlette.responses import Response, StreamingResponse

from service.http.encodings import MIN_GZIP_BYTES, Compressed, accepts

TEXT = b"the same again and again " * MIN_GZIP_BYTES
Message = MutableMapping[str, Any]


def sent(response: Response, taken: str = "gzip") -> tuple[dict[str, str], bytes]:
    """What comes of an answer, for a client that takes these codings."""
    messages: list[Message] = []

    async def receive() -> Message:
        return {"type": "http.disconnect"}

    async def send(message: Message) -> None:
        messages.append(message)

    scope = {"type": "http", "method": "GET", "path": "/", "headers": [(b"accept-encoding", taken.encode())]}
    asyncio.run(Compressed(response)(scope, receive, send))
    start, *rest = messages
    headers = {name.decode().lower(): value.decode() for name, value in start["headers"]}
    return headers, b"".join(message.get("body", b"") for message in rest)


def test_a_text_that_is_sent_whole_comes_by_gzip_with_its_new_length() -> None:
    headers, body = sent(Response(TEXT, media_type="application/json"))
    assert (headers["content-encoding"], headers["vary"]) == ("gzip", "Accept-Encoding")
    assert int(headers["content-length"]) == len(body) < len(TEXT) and gzip.decompress(body) == TEXT


@pytest.mark.parametrize(
    "response",
    [
        Response(TEXT, media_type="application/json", headers={"ETag": '"of these very bytes"'}),
        Response(TEXT, media_type="application/json", headers={"Content-Encoding": "br"}),
        Response(TEXT, media_type="video/mp4"),
        Response(TEXT[: MIN_GZIP_BYTES - 1], media_type="application/json"),
    ],
    ids=["its tag is of these bytes", "coded already", "no text", "short"],
)
def test_what_would_be_another_thing_or_no_shorter_goes_as_it_is(response: Response) -> None:
    headers, body = sent(response)
    assert headers.get("content-encoding") in (None, "br") and body == response.body


def test_a_stream_is_not_held_back() -> None:
    async def pieces() -> AsyncIterator[bytes]:
        yield TEXT
        yield TEXT

    headers, body = sent(StreamingResponse(pieces(), media_type="application/json"))
    assert "content-encoding" not in headers and body == 2 * TEXT


@pytest.mark.parametrize(
    ("header", "taken"),
    [
        ("gzip", True),
        ("br, GZip ;q=0.1", True),
        ("gzip;q=0", False),
        ("gzip; q=0.000", False),
        ("gzip;q=0.001", True),
        ("x-gzip, gzipped", False),
        ("", False),
        (None, False),
    ],
)
def test_a_coding_is_taken_if_it_is_named_and_not_refused(header: str | None, taken: bool) -> None:
    assert accepts(header, "gzip") is taken
    if header is not None:
        assert ("content-encoding" in sent(Response(TEXT, media_type="text/plain"), header)[0]) is taken
