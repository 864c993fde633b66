"""How requests get to the service, and what waits for them: the one line blocks, the other is of asyncio.

The rest of the client is written once, as coroutines over a line. Those of a blocking line never suspend, so that
`run` and `each` bring them to their end without an event loop, also inside of one that runs.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Coroutine, Generator, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any, Protocol, TypeVar

import httpx

T = TypeVar("T")
END_OF_LINES: Any = object()

OnSent = Callable[[], None]
"""Called whenever a piece of a request's body is about to be sent."""


class Line(Protocol):
    """What the operations need of the world."""

    def stream(
        self, method: str, address: str, sent: OnSent | None = None, **request: Any
    ) -> AbstractAsyncContextManager[httpx.Response]:
        """Send a request; its answer is not read yet."""

    async def read(self, response: httpx.Response) -> bytes:
        """The whole body of an answer, which also has it from then on."""

    def pieces(self, response: httpx.Response, size: int | None = None) -> AsyncGenerator[bytes]:
        """The body of an answer, as it comes."""

    def lines(self, response: httpx.Response) -> AsyncGenerator[str]:
        """The lines of an answer, as they come."""

    async def sleep(self, seconds: float) -> None:
        """Let time pass."""

    async def aside(self, work: Callable[..., T], *arguments: Any) -> T:
        """Do what takes the disk its time."""

    async def close(self) -> None:
        """Close the connections."""


class BlockingLine:
    """A line over `httpx.Client`: whatever takes time is waited for on the spot."""

    def __init__(self, http: httpx.Client):
        self._http = http

    @asynccontextmanager
    async def stream(
        self, method: str, address: str, sent: OnSent | None = None, **request: Any
    ) -> AsyncGenerator[httpx.Response]:
        made = self._http.build_request(method, address, **request)
        if sent is not None:
            made.stream = _Told(made.stream, sent)
        response = self._http.send(made, stream=True)
        try:
            yield response
        finally:
            response.close()

    async def read(self, response: httpx.Response) -> bytes:
        return response.read()

    async def pieces(self, response: httpx.Response, size: int | None = None) -> AsyncGenerator[bytes]:
        for piece in response.iter_raw(size):
            yield piece

    async def lines(self, response: httpx.Response) -> AsyncGenerator[str]:
        for line in response.iter_lines():
            yield line

    async def sleep(self, seconds: float) -> None:
        time.sleep(seconds)

    async def aside(self, work: Callable[..., T], *arguments: Any) -> T:
        return work(*arguments)

    async def close(self) -> None:
        self._http.close()


class AsyncLine:
    """A line over `httpx.AsyncClient`; files are read and written in threads, beside the event loop."""

    def __init__(self, http: httpx.AsyncClient):
        self._http = http

    @asynccontextmanager
    async def stream(
        self, method: str, address: str, sent: OnSent | None = None, **request: Any
    ) -> AsyncGenerator[httpx.Response]:
        made = self._http.build_request(method, address, **request)
        if sent is not None:
            made.stream = _ReadAside(made.stream, sent)
        response = await self._http.send(made, stream=True)
        try:
            yield response
        finally:
            await response.aclose()

    async def read(self, response: httpx.Response) -> bytes:
        return await response.aread()

    async def pieces(self, response: httpx.Response, size: int | None = None) -> AsyncGenerator[bytes]:
        async for piece in response.aiter_raw(size):
            yield piece

    async def lines(self, response: httpx.Response) -> AsyncGenerator[str]:
        async for line in response.aiter_lines():
            yield line

    async def sleep(self, seconds: float) -> None:
        await asyncio.sleep(seconds)

    async def aside(self, work: Callable[..., T], *arguments: Any) -> T:
        return await asyncio.to_thread(work, *arguments)

    async def close(self) -> None:
        await self._http.aclose()


class _Told(httpx.SyncByteStream):
    """A body that tells of each piece that is sent."""

    def __init__(self, body: Any, sent: OnSent):
        self._body = body
        self._sent = sent

    def __iter__(self) -> Iterator[bytes]:
        for piece in self._body:
            self._sent()
            yield piece


class _ReadAside(httpx.AsyncByteStream):
    """A body that threads read from its file."""

    def __init__(self, body: Any, sent: OnSent):
        self._body = body
        self._sent = sent

    async def __aiter__(self) -> AsyncIterator[bytes]:
        pieces = iter(self._body)
        while (piece := await asyncio.to_thread(next, pieces, END_OF_LINES)) is not END_OF_LINES:
            self._sent()
            yield piece


def run(work: Coroutine[Any, Any, T]) -> T:
    """What a coroutine over a blocking line returns."""
    try:
        work.send(None)
    except StopIteration as done:
        result: T = done.value
        return result
    work.close()
    raise RuntimeError("a blocking line never suspends")


def each(items: AsyncGenerator[T]) -> Generator[T]:
    """What an asynchronous generator over a blocking line yields."""

    async def following() -> T:
        return await anext(items, END_OF_LINES)

    async def close() -> None:
        await items.aclose()

    try:
        while (item := run(following())) is not END_OF_LINES:
            yield item
    finally:
        run(close())
