"""JSON bodies of requests: how every one is read."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from anyio.to_thread import run_sync
from fastapi import Request
from fastapi.routing import APIRoute
from starlette.responses import Response

from service.http import bodies
from service.http.documents import parse_json

JSON_TYPES = ("", "application/json")
"""Media types of bodies that are read as JSON."""


async def read_json(request: Request) -> Any:
    """What a JSON body holds. Raises a 413 or a 422 problem."""
    return await run_sync(parse_json, await bodies.read(request), "The body")


class _BoundedRequest(Request):
    """A request whose body FastAPI reads within the same bounds."""

    async def body(self) -> bytes:
        if not hasattr(self, "_read"):
            self._read = await bodies.read(self)
        return self._read

    async def json(self) -> Any:
        return await run_sync(parse_json, await self.body(), "The body")


class RequestModelRoute(APIRoute):
    """The class of every route whose body is a model in its signature (`APIRouter(route_class=RequestModelRoute)`)."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def bounded(request: Request) -> Response:
            return await handle(_BoundedRequest(request.scope, request.receive))

        return bounded
