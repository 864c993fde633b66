"""The client for asyncio."""

from __future__ import annotations

from types import TracebackType
from typing import Self

import httpx

from galatea_client.core import Core
from galatea_client.job import AsyncJob
from galatea_client.lines import AsyncLine
from galatea_client.requests import address_of, headers_of
from galatea_client.transport import Transport


class AsyncClient(Core[AsyncJob]):
    """A connection to a service for asyncio; an asynchronous context manager.

    It has the methods of `Client` with the same parameters: they are awaited, and what `Client` iterates over comes by
    `async for`. Parameters and errors are those of `Client`; `transport` is one such as `httpx.AsyncHTTPTransport`.
    """

    def __init__(
        self,
        base_url: str,
        key: str | None = None,
        retries: int = 4,
        patience: float = 60.0,
        timeout: float = 30.0,
        transport: httpx.AsyncBaseTransport | None = None,
    ):
        base = address_of(base_url)
        http = httpx.AsyncClient(base_url=base, headers=headers_of(key), timeout=timeout, transport=transport)
        super().__init__(Transport(AsyncLine(http), base, retries, patience), timeout, AsyncJob)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()
