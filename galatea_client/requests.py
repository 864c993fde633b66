"""Requests, and how their answers are read: what the methods of both clients are made of."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from typing import Any, Generic, TypeVar

import httpx

from galatea_client.errors import InvalidAddress
from galatea_client.job import JobDocument
from galatea_client.models import Model
from galatea_client.transport import Transport

J = TypeVar("J", bound=JobDocument)
M = TypeVar("M", bound=Model)
T = TypeVar("T")


class Requests(Generic[J]):
    """Requests by a transport whose line waits as the client does; `job_type` is what a job is read as."""

    def __init__(self, transport: Transport, timeout: float, job_type: type[J], owner: Any = None):
        """`owner` is the client that jobs are bound to, this by default."""
        self._transport = transport
        self._timeout = timeout
        self._job_type = job_type
        self._owner = owner or self

    async def close(self) -> None:
        """Close the connections."""
        await self._transport.line.close()

    async def _pages(self, read: Callable[[Any], T], operation: str, params: dict[str, Any]) -> AsyncGenerator[T]:
        while True:
            page = (await self._transport.call(operation, params=params)).json()
            for one in page["items"]:
                yield read(one)
            if page["next_cursor"] is None:
                return
            params = {**params, "cursor": page["next_cursor"]}

    async def _call(self, operation: str, again: bool | None = None, json: Any = None, **path: str) -> Any:
        body = {} if json is None else {"json": json}
        return (await self._transport.call(operation, again, path=path, **body)).json()

    def _job(self, document: Any) -> J:
        return self._read(self._job_type, document).bound(self._owner)

    def _read(self, model: type[M], document: Any) -> M:
        return model.model_validate(document, context=self._transport.context)


def headers_of(key: str | None) -> dict[str, str]:
    """The headers of every request."""
    return {"Accept-Encoding": "identity", **({"Authorization": f"Bearer {key}"} if key else {})}


def address_of(given: str) -> httpx.URL:
    """The service's address. Raises `InvalidAddress`."""
    try:
        url = httpx.URL(given.rstrip("/"))
    except (httpx.InvalidURL, AttributeError, TypeError) as error:
        raise InvalidAddress(f"{given!r} is no address: {error}") from error
    if url.scheme not in ("http", "https") or not url.host:
        raise InvalidAddress(f"{given!r} is no address: use one such as http://127.0.0.1:8000")
    return url
