"""tus 1.0, the protocol of resumable uploads (https://tus.io/protocols/resumable-upload): its version, its headers, and
what every one of its requests has in common."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from email.utils import format_datetime
from typing import Annotated, Any

from fastapi import Header, Request
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.routing import Match
from starlette.types import Scope

from service.auth.caller import InCaller
from service.files.admission import largest_mb
from service.problem_answers import invalid_request
from service.problems import Problem, phrase
from service.settings import BYTES_PER_MEGABYTE, Settings
from service.tables.uploads import Upload
from service.uploads.checksum import CHECKSUM_ALGORITHMS

TUS_VERSION = "1.0.0"
TUS_EXTENSIONS = ("creation", "creation-with-upload", "creation-defer-length", "checksum", "expiration", "termination")
PIECE_TYPE = "application/offset+octet-stream"
"""The media type of a piece."""

MAX_LENGTH_BYTES = 1 << 53
"""The longest upload: JavaScript knows no larger whole numbers."""

UploadLength = Annotated[int | None, Header(ge=0, le=MAX_LENGTH_BYTES, description="How long the whole upload is.")]
DeferLength = Annotated[
    int | None, Header(alias="Upload-Defer-Length", ge=1, le=1, description="1: the length will be told later.")
]
UploadOffset = Annotated[int, Header(ge=0, le=MAX_LENGTH_BYTES, description="Where the piece begins.")]
UploadMetadata = Annotated[
    str | None,
    Header(description="Keys with values in base64, separated by commas; `filename` and `filetype` are understood."),
]
UploadChecksum = Annotated[
    str | None,
    Header(
        description=f"The piece's checksum, `ALGORITHM BASE64`; one of {', '.join(CHECKSUM_ALGORITHMS)}.",
        json_schema_extra={"pattern": f"^({'|'.join(CHECKSUM_ALGORITHMS)}) [A-Za-z0-9+/]+=*$"},
    ),
]
ContentType = Annotated[str | None, Header(include_in_schema=False)]  # the request body says it


class TusRoute(APIRoute):
    """A request of the protocol: every answer names the protocol's version. A request that can only be sent as POST
    names its own method in `X-HTTP-Method-Override`."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def speak(request: Request) -> Response:
            try:
                response = await handle(request)
            except (Problem, RequestValidationError) as error:
                problem = error if isinstance(error, Problem) else invalid_request(error)
                problem.headers.setdefault("Tus-Resumable", TUS_VERSION)
                raise problem from error
            response.headers["Tus-Resumable"] = TUS_VERSION
            return response

        return speak

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        method = Headers(scope=scope).get("x-http-method-override", "") if scope["type"] == "http" else ""
        if scope.get("method") != "POST" or method not in ("PATCH", "DELETE"):
            return super().matches(scope)
        match, child = super().matches({**scope, "method": method})
        return match, {**child, "method": method}


async def require_version(
    caller: InCaller, tus_resumable: Annotated[str | None, Header(include_in_schema=False)] = None
) -> None:
    """Raise a problem if a request is not of this version of the protocol (412) or of none (400); who asks must be
    known before."""
    if tus_resumable == TUS_VERSION:
        return
    given = f"version {tus_resumable[:20]} is not spoken here" if tus_resumable else "the header is missing"
    raise Problem(
        412 if tus_resumable else 400,
        "tus_version",
        f"Uploads follow the tus protocol: send Tus-Resumable: {TUS_VERSION} ({given}), or upload the file by "
        "POST /v1/files.",
        headers={"Tus-Version": TUS_VERSION},
    )


def offered_headers(settings: Settings) -> dict[str, str]:
    """What the service can do, as OPTIONS tells it."""
    return {
        "Tus-Version": TUS_VERSION,
        "Tus-Extension": ",".join(TUS_EXTENSIONS),
        "Tus-Max-Size": str(int(largest_mb(settings) * BYTES_PER_MEGABYTE)),
        "Tus-Checksum-Algorithm": ",".join(CHECKSUM_ALGORITHMS),
    }


def state_headers(upload: Upload) -> dict[str, str]:
    """Where an upload stands, as headers."""
    headers = {"Upload-Offset": str(upload.received), "Cache-Control": "no-store"}
    if not upload.finished:
        headers["Upload-Expires"] = format_datetime(upload.expires_at, usegmt=True)
    return headers


def description_headers(upload: Upload) -> dict[str, str]:
    """What an upload is, as headers."""
    length = {"Upload-Defer-Length": "1"} if upload.length is None else {"Upload-Length": str(upload.length)}
    return length | ({"Upload-Metadata": upload.notes} if upload.notes else {})


TUS_HEADERS: dict[str, dict[str, Any]] = {
    name: {"description": what, "schema": {"type": kind}}
    for name, kind, what in (
        ("Location", "string", "The upload's address; its last part is the id, and later the file's."),
        ("Tus-Resumable", "string", "The protocol's version."),
        ("Tus-Version", "string", "The versions that are spoken."),
        ("Tus-Extension", "string", "The extensions of the protocol that are spoken."),
        ("Tus-Max-Size", "integer", "The longest upload, in bytes."),
        ("Tus-Checksum-Algorithm", "string", "The checksums that are understood."),
        ("Upload-Offset", "integer", "As many bytes are safely kept."),
        ("Upload-Length", "integer", "How long the whole upload is."),
        ("Upload-Defer-Length", "integer", "1 as long as the length is not known."),
        ("Upload-Metadata", "string", "As it was sent."),
        ("Upload-Expires", "string", "When the upload is erased unless more of it comes."),
    )
}


def documented_answer(status: int, text: str, *names: str) -> dict[int | str, dict[str, Any]]:
    """An answer and its headers, for the OpenAPI document."""
    return {status: {"description": text, "headers": {name: TUS_HEADERS[name] for name in ("Tus-Resumable", *names)}}}


def documented_bare_problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Problems that come without a body, for the OpenAPI document: HEAD is answered with headers only."""
    return {status: {"description": phrase(status)} for status in statuses}


def documented_request(body: bool | None = None) -> dict[str, Any]:
    """What a request must bring, for the OpenAPI document: the version, and a piece (`body`) or perhaps one (False)."""
    version = {"type": "string", "enum": [TUS_VERSION]}
    parameter = {"name": "Tus-Resumable", "in": "header", "required": True, "schema": version}
    needed: dict[str, Any] = {"parameters": [parameter | {"description": "The protocol's version."}]}
    if body is not None:
        content = {PIECE_TYPE: {"schema": {"type": "string", "format": "binary"}}}
        needed["requestBody"] = {"content": content, "required": body}
    return needed
