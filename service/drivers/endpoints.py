"""/drivers: the built-in performances and the user's own driving videos; and their videos and pictures."""

from __future__ import annotations

from fastapi import Request
from starlette.responses import Response

from service.auth.caller import Reader
from service.drivers import service
from service.drivers.schemas import DriverList, DriverOut
from service.http.delivery import DELIVERED_IN_PARTS, DELIVERY_RESPONSES, deliver, stored_file
from service.keeping.endpoints import Endpoints, library_router
from service.request_context import InContext

router = library_router(
    service.PRESENTED_DRIVERS,
    Endpoints(
        item=DriverOut,
        listed=DriverList,
        media_types="video/*",
        inspection="moments",
        inspect="search",
        list_says="The drivers that a job can name: the built-in performances, then the user's own.",
        keep_says="Keep a driving video under a name.",
        inspect_says="Search one of the user's own drivers for moments again. A new driver is searched by itself.",
        file_is="video",
    ),
)


@stored_file("/{name}/video", router, "get_driver_video", DELIVERED_IN_PARTS)
def get_driver_video(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """The video itself: whole, or the ranges asked for."""
    stored, storage = service.stored(context, caller.owner, name)
    return deliver(stored, storage, request)


@stored_file("/{name}/poster", router, "get_driver_poster", DELIVERY_RESPONSES)
def get_driver_poster(name: str, request: Request, caller: Reader, context: InContext) -> Response:
    """A small picture (JPEG) that shows what happens in it; of one's own drivers, the face at rest."""
    stored, storage = service.poster(context, caller.owner, name)
    return deliver(stored, storage, request)


@stored_file("/{name}/moments/{moment}/poster", router, "get_moment_poster", DELIVERY_RESPONSES)
def get_moment_poster(name: str, moment: str, request: Request, caller: Reader, context: InContext) -> Response:
    """A small picture (JPEG) of a moment at its height."""
    stored, storage = service.segment_poster(context, caller.owner, name, moment)
    return deliver(stored, storage, request)
