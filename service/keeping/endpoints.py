"""The endpoints that every library has: list, keep, show, inspect, rename and erase."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from pydantic import BaseModel
from starlette.responses import Response

from service.auth.caller import Reader, Submitter
from service.disk import require_space
from service.http.json_bodies import RequestModelRoute
from service.keeping import service
from service.keeping.presentation import Presentation, get_item, list_items
from service.keeping.request import KeptChange, body, keep_body
from service.problems import responses
from service.request_context import InContext


@dataclass(frozen=True)
class Endpoints:
    """What the endpoints of a library are called, and what the OpenAPI document says of them."""

    item: type[BaseModel]
    """The model of what is shown of one thing."""
    listed: type[BaseModel]
    """The model of a list of them, its `items`."""
    media_types: str
    """What a file may be, as it stands in an `Accept`."""
    inspection: str
    """The address of the inspection below that of a thing."""
    inspect: str
    """What the inspection does, as a verb: `search_driver`."""
    list_says: str
    keep_says: str
    inspect_says: str
    file_is: str
    """What the file of a kept thing is."""


def library_router(presented: Presentation[Any, Any], named: Endpoints) -> APIRouter:
    """The endpoints of a library, below its address."""
    nouns = f"{presented.library.noun}s"
    router = APIRouter(prefix=f"/{nouns}", tags=[nouns], route_class=RequestModelRoute)
    _list_and_keep(router, presented, named)
    _show_and_inspect(router, presented, named)
    _rename_and_erase(router, presented, named)
    return router


def _list_and_keep(router: APIRouter, presented: Presentation[Any, Any], named: Endpoints) -> None:
    library, noun = presented.library, presented.library.noun

    @router.get("", response_model=named.listed, **_about(f"list_{noun}s", named.list_says))
    def list_all(caller: Reader, context: InContext) -> dict[str, Any]:
        return {"items": list_items(context, presented, caller.owner)}

    @router.post(
        "",
        status_code=201,
        response_model=named.item,
        openapi_extra=body(named.media_types),
        responses=responses(409, 413, 415, 422, 507),
        **_about(f"create_{noun}", named.keep_says),
    )
    async def keep(request: Request, response: Response, caller: Submitter, context: InContext) -> Any:
        name = await keep_body(request, context, caller, library)
        response.headers["Location"] = f"{library.address}/{name}"
        return await run_sync(get_item, context, presented, caller.owner, name)


def _show_and_inspect(router: APIRouter, presented: Presentation[Any, Any], named: Endpoints) -> None:
    library, noun = presented.library, presented.library.noun
    says = f"What is known of a {noun}."

    @router.get("/{name}", response_model=named.item, responses=responses(404), **_about(f"get_{noun}", says))
    def show(name: str, caller: Reader, context: InContext) -> Any:
        return get_item(context, presented, caller.owner, name)

    @router.post(
        f"/{{name}}/{named.inspection}",
        status_code=202,
        response_model=named.item,
        responses=responses(404, 409, 422, 507),
        **_about(f"{named.inspect}_{noun}", named.inspect_says),
    )
    def inspect(name: str, caller: Submitter, context: InContext) -> Any:
        require_space(context.settings)
        service.inspect_again(context, library, caller.owner, name)
        return get_item(context, presented, caller.owner, name)


def _rename_and_erase(router: APIRouter, presented: Presentation[Any, Any], named: Endpoints) -> None:
    library, noun = presented.library, presented.library.noun
    says = f"Give one of the user's own {noun}s another name. Jobs that use it stay as they are."

    @router.patch(
        "/{name}", response_model=named.item, responses=responses(404, 409, 422), **_about(f"rename_{noun}", says)
    )
    def rename(name: str, requested: KeptChange, caller: Submitter, context: InContext) -> Any:
        service.rename(context, library, caller.owner, name, requested.name)
        return get_item(context, presented, caller.owner, requested.name)

    says = f"Erase one of the user's own {noun}s. Jobs that use it keep its {named.file_is} until they are deleted."

    @router.delete("/{name}", status_code=204, responses=responses(404, 409), **_about(f"delete_{noun}", says))
    def delete(name: str, caller: Submitter, context: InContext) -> None:
        service.delete(context, library, caller.owner, name)


def _about(operation: str, says: str) -> dict[str, Any]:
    """What the OpenAPI document says of an operation."""
    return {"operation_id": operation, "name": operation, "description": says}
