"""Resumable uploads: OPTIONS and POST /uploads; HEAD, PATCH, DELETE and GET /uploads/{id}."""

from __future__ import annotations

from anyio.to_thread import run_sync
from fastapi import APIRouter, Depends, Request
from starlette.responses import JSONResponse, Response

from service.auth.caller import Caller, Reader, Submitter
from service.context import Context
from service.disk import require_space
from service.http.bodies import announced_bytes
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.uploads import Upload
from service.uploads import protocol, service
from service.uploads.checksum import Checksum
from service.uploads.protocol import (
    PIECE_TYPE,
    ContentType,
    DeferLength,
    TusRoute,
    UploadChecksum,
    UploadLength,
    UploadMetadata,
    UploadOffset,
    documented_answer,
    documented_bare_problems,
)
from service.uploads.reception import Reception
from service.uploads.schemas import UploadOut
from service.uploads.under_way import ActiveUploads, InUnderWay

tus = APIRouter(prefix="/uploads", tags=["uploads"], route_class=TusRoute)
of_version = [Depends(protocol.require_version)]
plain = APIRouter(prefix="/uploads", tags=["uploads"])
router = APIRouter()


@tus.options("/{upload_id}", status_code=204, include_in_schema=False)
@tus.options(
    "",
    status_code=204,
    operation_id="describe_uploads",
    responses=documented_answer(
        204, "What is offered", "Tus-Version", "Tus-Extension", "Tus-Max-Size", "Tus-Checksum-Algorithm"
    ),
)
def describe_uploads(caller: Reader, context: InContext) -> Response:
    """What of the tus protocol is offered."""
    return Response(status_code=204, headers=protocol.offered_headers(context.settings))


@tus.post(
    "",
    dependencies=of_version,
    status_code=201,
    operation_id="create_upload",
    response_model=UploadOut,
    openapi_extra=protocol.documented_request(body=False),
    responses=documented_answer(201, "The upload", "Location", "Upload-Offset", "Upload-Expires")
    | responses(400, 408, 410, 412, 413, 415, 422, 423, 460, 503, 507),
)
async def create_upload(
    request: Request,
    caller: Submitter,
    context: InContext,
    under_way: InUnderWay,
    upload_length: UploadLength = None,
    defer_length: DeferLength = None,
    upload_metadata: UploadMetadata = None,
    upload_checksum: UploadChecksum = None,
    content_type: ContentType = None,
) -> Response:
    """Begin an upload, with its first piece if one is sent along. Once all of it has come, it is the file with its id;
    before that, it is erased when nothing more comes for a while."""
    if (upload_length is None) == (defer_length is None):
        raise Problem(422, "length_missing", "Send either Upload-Length or Upload-Defer-Length: 1.")
    piece = content_type == PIECE_TYPE
    if not piece and request.headers.get("content-length", "0") != "0":
        raise Problem(415, "body_type_unsupported", f"Send the first piece as {PIECE_TYPE}, or no body.")
    checksum = Checksum(upload_checksum) if upload_checksum is not None else None
    upload = await run_sync(service.create, context, caller.owner, upload_length, upload_metadata)
    if piece:
        await _receive(request, caller, context, under_way, upload.id, 0, None, checksum)
    shown, file = await run_sync(service.found, context, caller.owner, upload.id)
    headers = {"Location": f"/v1/uploads/{upload.id}", **protocol.state_headers(shown)}
    return JSONResponse(UploadOut.of(shown, file).model_dump(mode="json"), 201, headers=headers)


@tus.head(
    "/{upload_id}",
    dependencies=of_version,
    operation_id="resume_upload",
    openapi_extra=protocol.documented_request(),
    response_class=Response,
    responses=documented_answer(
        200,
        "Where the upload stands",
        *("Upload-Offset", "Upload-Length", "Upload-Defer-Length", "Upload-Metadata", "Upload-Expires"),
    )
    | documented_bare_problems(400, 404, 410, 412, 422, 423),
)
async def resume_upload(upload_id: str, caller: Submitter, context: InContext, under_way: InUnderWay) -> Response:
    """Where to go on. Whatever request is still at the upload is ended, so that the answer holds."""
    await run_sync(service.found, context, caller.owner, upload_id)
    async with under_way.hold(upload_id):
        upload, _ = await run_sync(service.found, context, caller.owner, upload_id)
    return Response(status_code=200, headers=protocol.state_headers(upload) | protocol.description_headers(upload))


@tus.patch(
    "/{upload_id}",
    dependencies=of_version,
    status_code=204,
    operation_id="add_to_upload",
    openapi_extra=protocol.documented_request(body=True),
    responses=documented_answer(204, "The piece is kept", "Upload-Offset", "Upload-Expires")
    | responses(400, 404, 408, 409, 410, 412, 413, 415, 422, 423, 460, 503, 507),
)
async def add_to_upload(
    upload_id: str,
    request: Request,
    caller: Submitter,
    context: InContext,
    under_way: InUnderWay,
    upload_offset: UploadOffset,
    upload_length: UploadLength = None,
    upload_checksum: UploadChecksum = None,
    content_type: ContentType = None,
) -> Response:
    """Add a piece, which begins where the upload stands. What came of it before the line broke is kept, unless it has
    a checksum to meet. The last piece makes the upload a file."""
    if content_type != PIECE_TYPE:
        raise Problem(415, "body_type_unsupported", f"Send a piece as {PIECE_TYPE}.")
    checksum = Checksum(upload_checksum) if upload_checksum is not None else None
    upload = await _receive(request, caller, context, under_way, upload_id, upload_offset, upload_length, checksum)
    return Response(status_code=204, headers=protocol.state_headers(upload))


@tus.delete(
    "/{upload_id}",
    dependencies=of_version,
    status_code=204,
    operation_id="end_upload",
    openapi_extra=protocol.documented_request(),
    responses=documented_answer(204, "Erased") | responses(400, 404, 410, 412, 422, 423),
)
async def end_upload(upload_id: str, caller: Submitter, context: InContext, under_way: InUnderWay) -> Response:
    """End an upload and erase what came of it. A file that it became goes too, unless a job or a driver uses it."""
    await run_sync(service.found, context, caller.owner, upload_id)
    async with under_way.hold(upload_id):
        upload, _ = await run_sync(service.found, context, caller.owner, upload_id)
        await run_sync(service.terminate, context, upload)
    under_way.forget(upload_id)
    return Response(status_code=204)


@plain.get("/{upload_id}", operation_id="get_upload", responses=responses(404, 410))
def get_upload(upload_id: str, caller: Reader, context: InContext) -> UploadOut:
    """An upload: how much of it has come, and the file that it became. Disturbs nobody, unlike HEAD."""
    return UploadOut.of(*service.found(context, caller.owner, upload_id))


router.include_router(tus)
router.include_router(plain)


async def _receive(
    request: Request,
    caller: Caller,
    context: Context,
    under_way: ActiveUploads,
    upload_id: str,
    offset: int,
    length: int | None,
    checksum: Checksum | None,
) -> Upload:
    """Add the body of a request to an upload. Raises `Problem`."""
    await run_sync(service.found, context, caller.owner, upload_id)  # before anybody is asked to let go
    async with under_way.hold(upload_id) as hold:
        upload, _ = await run_sync(service.found, context, caller.owner, upload_id)
        if offset != upload.received:
            raise Problem(
                409,
                "offset_mismatch",
                f"The upload stands at {upload.received}, not at {offset}: send what comes from there.",
                headers={"Upload-Offset": str(upload.received)},
            )
        service.require_length(context, upload, length)
        length = upload.length if length is None else length
        coming = announced_bytes(request)
        if length is not None and offset + coming > length:
            raise Problem(
                413,
                "length_exceeded",
                f"The upload is {length} bytes long, and more was sent: begin again with the right Upload-Length.",
            )
        require_space(context.settings, coming)
        if upload.finished:
            return upload
        reception = Reception(context, upload, length, under_way.digest(upload_id), checksum)
        await service.receive(request, hold, reception)
    if reception.file is not None:
        under_way.forget(upload_id)
    return upload
