"""POST /files, GET /files/{id} and its content."""

from __future__ import annotations

from typing import Any

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request
from starlette.responses import Response

from service.auth.caller import Caller, Reader, Submitter
from service.context import Context
from service.files import repository, service
from service.files.intake import Form
from service.files.schemas import FileOut
from service.http.delivery import DELIVERED_IN_PARTS, deliver, stored_file
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.files import File

router = APIRouter(prefix="/files", tags=["files"])

UPLOAD_REQUEST: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "required": ["file"],
                    "properties": {"file": {"type": "string", "format": "binary"}},
                    "additionalProperties": False,
                },
                "encoding": {
                    "file": {
                        "contentType": "image/*, video/*, text/x-bvh, model/gltf-binary, model/gltf+json, application/zip,"
                        " application/x-tar"
                    }
                },
            }
        },
    }
}


@router.post(
    "",
    status_code=201,
    operation_id="create_file",
    openapi_extra=UPLOAD_REQUEST,
    responses=responses(413, 415, 422, 507),
)
async def create_file(request: Request, response: Response, caller: Submitter, context: InContext) -> FileOut:
    """Upload one file. It is erased after a while if no job uses it."""
    require_multipart(request)
    async with Form(request, context.settings, most_files=1, files=("file",)) as form:
        if not form.files:
            raise Problem(422, "file_missing", "Send the file as a part of the multipart body.")
        file = await run_sync(service.keep, context, caller.owner, form.files[0])
    response.headers["Location"] = f"/v1/files/{file.id}"
    return FileOut.of(file)


@router.get("/{file_id}", operation_id="get_file", responses=responses(404))
def get_file(file_id: str, caller: Reader, context: InContext) -> FileOut:
    """What is known of a file."""
    return FileOut.of(_found(context, caller, file_id))


@stored_file("/{file_id}/content", router, "get_file_content", DELIVERED_IN_PARTS)
def get_file_content(file_id: str, request: Request, caller: Reader, context: InContext) -> Response:
    """The file itself: whole, or the ranges asked for."""
    stored = _found(context, caller, file_id).stored
    return deliver(stored, context.storage, request)


def require_multipart(request: Request) -> None:
    """Raise a 415 problem if the body is no form."""
    if not request.headers.get("content-type", "").lower().startswith("multipart/form-data"):
        raise Problem(415, "body_type_unsupported", "Send the body as multipart/form-data.")


def _found(context: Context, caller: Caller, file_id: str) -> File:
    with context.database.read() as session:
        file = repository.get(session, caller.owner, file_id)
    if file is None:
        raise Problem(404, "file_not_found", "There is no such file: it was erased, or it never was.")
    return file
