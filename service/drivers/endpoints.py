"""GET, POST, PATCH and DELETE /drivers: the built-in performances and the user's own driving videos."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.artifacts.delivery import DELIVERED, DELIVERED_IN_PARTS, deliver
from service.asked import AskedRoute
from service.auth.caller import Reader, Submitter
from service.context import InContext
from service.drivers import service
from service.drivers.schemas import DriverList, DriverOut
from service.kept import endpoints as kept
from service.kept import service as keeping
from service.kept.request import KeptChange, body
from service.kept.shelves import DRIVERS
from service.problems import responses

router = APIRouter(prefix="/drivers", tags=["drivers"], route_class=AskedRoute)


@router.get("", operation_id="list_drivers")
def list_drivers(caller: Reader, context: InContext) -> DriverList:
    """The drivers that a job can name: the built-in performances, then the user's own."""
    return DriverList(items=service.all_drivers(context, caller.owner))


@router.post(
    "",
    status_code=201,
    operation_id="create_driver",
    openapi_extra=body("video/*"),
    responses=responses(409, 413, 415, 422, 507),
)
async def create_driver(request: Request, response: Response, caller: Submitter, context: InContext) -> DriverOut:
    """Keep a driving video under a name."""
    return await kept.create(DRIVERS, service.one_driver, request, response, caller, context)


@router.get("/{name}", operation_id="get_driver", responses=responses(404))
def get_driver(name: str, caller: Reader, context: InContext) -> DriverOut:
    """What is known of a driver."""
    return service.one_driver(context, caller.owner, name)


@router.post(
    "/{name}/moments",
    status_code=202,
    operation_id="search_driver",
    responses=responses(404, 409, 422, 507),
)
def search_driver(name: str, caller: Submitter, context: InContext) -> DriverOut:
    """Search one of the user's own drivers for moments again. A new driver is searched by itself."""
    return kept.look_again(DRIVERS, service.one_driver, name, caller, context)


@router.patch("/{name}", operation_id="rename_driver", responses=responses(404, 409, 422))
def rename_driver(name: str, asked: KeptChange, caller: Submitter, context: InContext) -> DriverOut:
    """Give one of the user's own drivers another name. Jobs that use it stay as they are."""
    return kept.rename(DRIVERS, service.one_driver, name, asked.name, caller, context)


@router.delete("/{name}", status_code=204, operation_id="delete_driver", responses=responses(404, 409))
def delete_driver(name: str, caller: Submitter, context: InContext) -> None:
    """Erase one of the user's own drivers. Jobs that use it keep its video until they are deleted."""
    keeping.delete(context, DRIVERS, caller.owner, name)


@router.head("/{name}/video", include_in_schema=False)
@router.get(
    "/{name}/video",
    operation_id="get_driver_video",
    response_class=Response,
    responses=DELIVERED_IN_PARTS,
)
def get_driver_video(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """The video itself: whole, or the ranges asked for."""
    stored, storage = service.stored(context, caller.owner, name)
    return deliver(stored, storage, request.headers, request.method == "HEAD")


@router.head("/{name}/poster", include_in_schema=False)
@router.get(
    "/{name}/poster",
    operation_id="get_driver_poster",
    response_class=Response,
    responses=DELIVERED,
)
def get_driver_poster(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """A small picture (JPEG) that shows what happens in it; of one's own drivers, the face at rest."""
    stored, storage = service.poster(context, caller.owner, name)
    return deliver(stored, storage, request.headers, request.method == "HEAD")


@router.head("/{name}/moments/{moment}/poster", include_in_schema=False)
@router.get(
    "/{name}/moments/{moment}/poster",
    operation_id="get_moment_poster",
    response_class=Response,
    responses=DELIVERED,
)
def get_moment_poster(name: str, moment: str, request: Request, caller: Reader, context: InContext) -> Response:
    """A small picture (JPEG) of a moment at its height."""
    stored, storage = service.moment_poster(context, caller.owner, name, moment)
    return deliver(stored, storage, request.headers, request.method == "HEAD")
