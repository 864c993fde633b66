"""A way to the service that breaks in the middle of answers, as real lines do."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterator

import httpx


class BrokenLine(httpx.BaseTransport):
    """Passes requests on to the service; an answer to `path` breaks off after so many bytes, `times` times."""

    def __init__(self, path: str, after_bytes: int, times: int):
        self.requests: list[httpx.Request] = []
        self._inner = httpx.HTTPTransport()
        self._path = path
        self._after = after_bytes
        self.times = times

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        response = self._inner.handle_request(request)
        if self._path in request.url.path and self.times > 0:
            self.times -= 1
            stream = _Cut(response.stream, self._after)
            return httpx.Response(response.status_code, headers=response.headers, stream=stream)
        return response

    def close(self) -> None:
        self._inner.close()


class AsyncBrokenLine(httpx.AsyncBaseTransport):
    """The same for `AsyncClient`."""

    def __init__(self, path: str, after_bytes: int, times: int):
        self.requests: list[httpx.Request] = []
        self._inner = httpx.AsyncHTTPTransport()
        self._path = path
        self._after = after_bytes
        self.times = times

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        response = await self._inner.handle_async_request(request)
        if self._path in request.url.path and self.times > 0:
            self.times -= 1
            stream = _AsyncCut(response.stream, self._after)
            return httpx.Response(response.status_code, headers=response.headers, stream=stream)
        return response

    async def aclose(self) -> None:
        await self._inner.aclose()


class _AsyncCut(httpx.AsyncByteStream):
    def __init__(self, stream: object, after: int):
        self._stream = stream
        self._left = after

    async def __aiter__(self) -> AsyncIterator[bytes]:
        async for piece in self._stream:  # type: ignore[attr-defined]
            yield piece[: self._left]
            self._left -= len(piece)
            if self._left <= 0:
                raise httpx.ReadError("the line broke")

    async def aclose(self) -> None:
        await self._stream.aclose()  # type: ignore[attr-defined]


class _Cut(httpx.SyncByteStream):
    def __init__(self, stream: object, after: int):
        self._stream = stream
        self._left = after

    def __iter__(self) -> Iterator[bytes]:
        for piece in self._stream:  # type: ignore[attr-defined]
            yield piece[: self._left]
            self._left -= len(piece)
            if self._left <= 0:
                raise httpx.ReadError("the line broke")

    def close(self) -> None:
        self._stream.close()  # type: ignore[attr-defined]
