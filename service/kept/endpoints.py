"""What the endpoints of every shelf do alike; what they show of a kept thing is their own."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from anyio.to_thread import run_sync
from fastapi import Request
from starlette.responses import Response

from service.auth.caller import Caller
from service.context import Context
from service.disk import require_space
from service.kept import service
from service.kept.request import keep_body
from service.kept.shelves import Shelf

Out = TypeVar("Out")
Show = Callable[[Context, str, str], Out]
"""What clients see of the thing of that owner and name."""


async def create(
    shelf: Shelf, show: Show[Out], request: Request, response: Response, caller: Caller, context: Context
) -> Out:
    """Keep what the request's body holds, and say where it is. Raises `Problem`."""
    name = await keep_body(request, context, caller, shelf)
    response.headers["Location"] = f"{shelf.address}/{name}"
    return await run_sync(show, context, caller.owner, name)


def rename(shelf: Shelf, show: Show[Out], name: str, new: str, caller: Caller, context: Context) -> Out:
    """Give something another name. Raises `Problem`."""
    service.rename(context, shelf, caller.owner, name, new)
    return show(context, caller.owner, new)


def look_again(shelf: Shelf, show: Show[Out], name: str, caller: Caller, context: Context) -> Out:
    """Look into a kept file anew. Raises `Problem`."""
    require_space(context.settings)
    service.look_again(context, shelf, caller.owner, name)
    return show(context, caller.owner, name)
