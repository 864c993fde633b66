"""Sending requests: again where that is safe and of use, and errors as exceptions."""

from __future__ import annotations

import random
from collections.abc import AsyncGenerator, Mapping
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any
from urllib.parse import quote

import httpx

from galatea_client.errors import Unreachable, error_of
from galatea_client.lines import Line
from galatea_client.operations import OPERATIONS

SAFE_METHODS = ("GET", "DELETE")
"""Sent twice, they do what they do once."""
WAIT_STATUSES = (429, 503)
MAX_BACK_OFF_SECONDS = 30.0


class Transport:
    """Sends the operations of the API.

    `retries` is how often a request is sent again after the first time; `patience` the longest that one `Retry-After`
    is waited for, in seconds: beyond it the error is raised at once.
    """

    def __init__(self, line: Line, base: httpx.URL, retries: int, patience: float):
        self.line = line
        self.base = base
        self.context = {"base": str(base).rstrip("/")}
        self.retries = retries
        self.patience = patience

    async def call(self, operation: str, again: bool | None = None, **request: Any) -> httpx.Response:
        """Send an operation and read its answer (see `stream`). Raises `ApiError` and `Unreachable`."""
        async with self.stream(operation, again, whole=True, **request) as response:
            return response

    @asynccontextmanager
    async def stream(
        self,
        operation: str,
        again: bool | None = None,
        path: Mapping[str, str] | None = None,
        whole: bool = False,
        **request: Any,
    ) -> AsyncGenerator[httpx.Response]:
        """Send an operation; unless its `whole` answer is asked for, it is not read yet. `path` fills the gaps of its
        address.

        `again` says whether it may be sent again when the line broke, so that nobody knows what became of it; by
        default for GET and DELETE. Where the service itself said to come back later, it always is.
        """
        method, template = OPERATIONS[operation]
        address = template.format(**{name: quote(value, safe="") for name, value in (path or {}).items()})
        safe = method in SAFE_METHODS if again is None else again
        for attempt in range(self.retries + 1):
            last = attempt == self.retries
            async with AsyncExitStack() as stack:
                try:
                    response = await stack.enter_async_context(self.line.stream(method, address, **request))
                    if whole or response.is_error:
                        await self.line.read(response)
                except httpx.TransportError as error:
                    if last or not (safe or isinstance(error, httpx.ConnectError)):
                        raise Unreachable(f"{self.base}: {error or type(error).__name__}") from error
                    wait = self._back_off(attempt)
                else:
                    if not response.is_error:
                        yield response
                        return
                    said = self._wait(response, attempt)
                    if last or said is None:
                        raise error_of(response)
                    wait = said
            await self.line.sleep(wait)

    def _wait(self, response: httpx.Response, attempt: int) -> float | None:
        """How long to wait before the request is sent again; None: there is no use in it."""
        if response.status_code not in WAIT_STATUSES:
            return None
        said = response.headers.get("retry-after", "")
        wait = float(said) if said.isascii() and said.isdigit() else self._back_off(attempt)
        return wait if wait <= self.patience else None

    @staticmethod
    def _back_off(attempt: int) -> float:
        return min(MAX_BACK_OFF_SECONDS, 0.5 * 2**attempt) * random.uniform(0.5, 1.0)
