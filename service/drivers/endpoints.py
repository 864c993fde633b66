"""GET, POST and DELETE /drivers: the built-in performances and the user's own driving videos."""

from __future__ import annotations

from typing import Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from starlette.responses import Response

from engine.media.sniff import VIDEO_TYPES
from service.artifacts.delivery import deliver
from service.context import InContext
from service.disk import require_space
from service.drivers import service
from service.drivers.schemas import DriverList, DriverOut
from service.files import service as files
from service.files.endpoints import require_multipart
from service.files.intake import Form
from service.problems import Problem, responses

router = APIRouter(prefix="/drivers", tags=["drivers"])

UPLOAD: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "required": ["name", "file"],
                    "properties": {"name": {"type": "string"}, "file": {"type": "string", "format": "binary"}},
                }
            }
        },
    }
}


@router.get("", operation_id="list_drivers")
def list_drivers(context: InContext) -> DriverList:
    """The drivers that a job can name: the built-in performances, then the user's own."""
    return DriverList(items=service.all_drivers(context))


@router.post(
    "",
    status_code=201,
    operation_id="create_driver",
    openapi_extra=UPLOAD,
    responses=responses(409, 413, 415, 422, 507),
)
async def create_driver(request: Request, response: Response, context: InContext) -> DriverOut:
    """Keep a driving video under a name."""
    require_multipart(request)
    require_space(context.settings)
    async with Form(request, context.settings, most_files=1) as form:
        name = form.fields.get("name", "")
        service.require_free_name(context, name)
        if not form.files:
            raise Problem(422, "file_missing", "Send the video as a part of the multipart body.")
        if form.files[0].content_type not in VIDEO_TYPES:
            raise Problem(415, "input_wrong_media", f"A driver is a video; this is {form.files[0].content_type}.")
        file = await run_sync(files.keep, context, form.files[0])
        try:
            driver = await run_sync(service.keep, context, name, file)
        finally:
            await run_sync(files.erase_unused, context, [file.id])
    response.headers["Location"] = f"/v1/drivers/{name}"
    return driver


@router.delete("/{name}", status_code=204, operation_id="delete_driver", responses=responses(404, 409))
def delete_driver(name: str, context: InContext) -> None:
    """Erase one of the user's own drivers. Jobs that use it keep its video until they are deleted."""
    service.delete(context, name)


@router.head("/{name}/video", include_in_schema=False)
@router.get(
    "/{name}/video",
    operation_id="get_driver_video",
    response_class=Response,
    responses={206: {"description": "The asked parts"}, 304: {"description": "Not modified"}, **responses(404, 416)},
)
def get_driver_video(name: str, request: Request, context: InContext) -> Response:
    """The video itself: whole, or the ranges asked for."""
    stored, storage = service.stored(context, name)
    return deliver(stored, storage, request.headers, request.method == "HEAD")
