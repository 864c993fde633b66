"""Errors as the API tells them: RFC 9457 problem documents with a stable `code`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from errno import EDQUOT, ENOSPC
from http import HTTPStatus
from types import MappingProxyType
from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ValidationError
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import Response
from starlette.routing import Match
from starlette.types import Scope

from engine.unknown_options import with_suggestions
from service.database.postgresql import UNTRANSLATABLE_CODE, error_code
from service.database.sessions import database_unavailable
from service.storage.files import StorageUnavailable
from service.traces.current import current_request
from service.traces.requests import HTTP_METHODS
from service.vault import SecretUnreadable

MEDIA_TYPE = "application/problem+json"
RETRY_SECONDS = 5
"""After how long it is worth trying again where something does not answer."""
MAX_ERRORS = 10
"""How many wrong fields are told of in one answer: a stranger may send many thousands."""
MAX_POINTER_CHARACTERS = 300
"""Characters of an answer's pointer, at most: it may repeat what a request held."""
MAX_DETAIL_CHARACTERS = 2000
"""Characters of an answer's detail, at most: it may repeat what a request held."""

STATUS_HEADERS = {
    401: {"WWW-Authenticate": {"description": "How to authenticate.", "required": True, "schema": {"type": "string"}}},
    405: {"Allow": {"description": "The methods on offer.", "required": True, "schema": {"type": "string"}}},
    416: {"Content-Range": {"description": "How long the file is.", "required": True, "schema": {"type": "string"}}},
    429: {"Retry-After": {"description": "Seconds.", "required": True, "schema": {"type": "integer"}}},
}
"""What comes with a problem of some status."""


STATUS_PHRASES = {460: "Checksum Mismatch"}
"""The phrases of statuses that HTTP itself does not know (460 is of the tus protocol)."""


class FieldError(BaseModel):
    """One field that is wrong."""

    pointer: str
    """JSON pointer to the field."""
    code: str
    detail: str


class ProblemDocument(BaseModel):
    """What every error answers."""

    type: str
    title: str
    status: int
    code: str
    """Stable: safe to compare with."""
    detail: str
    """What to do."""
    errors: list[FieldError] | None = None
    """The fields that are wrong, the first ten of them."""
    request_id: str | None = None
    """Of the request, as in the service's log."""


class Problem(Exception):
    """Raised anywhere behind the API to answer with a problem document."""

    def __init__(
        self,
        status: int,
        code: str,
        detail: str,
        errors: Sequence[FieldError] = (),
        headers: Mapping[str, str] | None = None,
    ):
        super().__init__(f"{code}: {detail}")
        self.status = status
        self.code = code
        self.detail = _cut(detail, MAX_DETAIL_CHARACTERS)
        self.errors = [
            FieldError(
                pointer=_cut(e.pointer, MAX_POINTER_CHARACTERS),
                code=e.code,
                detail=_cut(e.detail, MAX_DETAIL_CHARACTERS),
            )
            for e in errors[:MAX_ERRORS]
        ]
        self.headers = dict(headers or {})

    def response(self) -> JSONResponse:
        request = current_request()
        request.problem = self.code
        document = ProblemDocument(
            type=f"urn:galatea:problem:{self.code}",
            title=phrase(self.status),
            status=self.status,
            code=self.code,
            detail=self.detail,
            errors=self.errors or None,
            request_id=request.id,
        )
        return JSONResponse(
            document.model_dump(exclude_none=True), self.status, headers=self.headers, media_type=MEDIA_TYPE
        )


def _cut(text: str, longest: int) -> str:
    return text if len(text) <= longest else text[: longest - 1] + "…"


def field_errors(
    errors: Sequence[Any], prefix: str = "", elsewhere: Mapping[str, str] = MappingProxyType({})
) -> list[FieldError]:
    """pydantic's errors as JSON pointers below `prefix`, or below what `elsewhere` has for the outermost name; no more
    than are told of."""

    def pointer(location: Sequence[Any]) -> str:
        place = elsewhere.get(str(location[0]), prefix) if location else prefix
        return place + "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in location)

    return [FieldError(pointer=pointer(e["loc"]), code=e["type"], detail=e["msg"]) for e in errors[:MAX_ERRORS]]


def _invalid(code: str, errors: Sequence[FieldError], count: int) -> Problem:
    """The 422 problem for `errors`, the first of `count`."""
    first = errors[0]
    more = f" There are {count - 1} more errors." if count > MAX_ERRORS else ""
    return Problem(422, code, f"{first.pointer or 'The request'}: {first.detail}{more}", errors)


def invalid(
    error: ValidationError,
    code: str,
    prefix: str = "",
    options: type[BaseModel] | None = None,
    elsewhere: Mapping[str, str] = MappingProxyType({}),
) -> Problem:
    """The 422 problem for a pydantic error (see `field_errors`); of an option that is none of a job kind's `options`, with
    those that are."""
    told = error.errors(include_url=False, include_context=False, include_input=False)
    count = len(told)
    if options is not None:
        told = with_suggestions(told[:MAX_ERRORS], options)
    return _invalid(code, field_errors(told, prefix, elsewhere), count)


def invalid_request(error: RequestValidationError) -> Problem:
    """The 422 problem for a request whose parts are not as the OpenAPI document says."""
    told = error.errors()
    return _invalid("invalid_request", field_errors(told), len(told))


def install(app: FastAPI) -> None:
    """Make every error of the application a problem document."""

    @app.exception_handler(Problem)
    async def problem(request: Request, error: Problem) -> JSONResponse:
        return error.response()

    @app.exception_handler(RequestValidationError)
    async def validation(request: Request, error: RequestValidationError) -> JSONResponse:
        return invalid_request(error).response()

    @app.exception_handler(HTTPException)
    async def http(request: Request, error: HTTPException) -> JSONResponse:
        if isinstance(
            error.__cause__, Problem
        ):  # what `service.http.request_models` says of a body, as FastAPI passes it on
            return error.__cause__.response()
        if error.status_code == 405:
            error.headers = {"Allow": ", ".join(_methods(app, request.scope))}
        code = {404: "not_found", 405: "method_not_allowed"}.get(error.status_code, f"http_{error.status_code}")
        detail = {
            404: "There is nothing at this address.",
            405: f"{request.method} is not offered at this address.",
        }.get(error.status_code, str(error.detail))
        return Problem(error.status_code, code, detail, headers=error.headers).response()

    @app.exception_handler(SecretUnreadable)
    async def locked(request: Request, error: SecretUnreadable) -> JSONResponse:
        structlog.get_logger().error("secret_unreadable", path=request.url.path)
        return Problem(503, "secret_unreadable", str(error)).response()

    @app.exception_handler(ClientDisconnect)
    async def disconnected(request: Request, error: ClientDisconnect) -> Response:
        return Response(status_code=400)  # nobody is there to read it

    @app.exception_handler(OSError)
    @app.exception_handler(SQLAlchemyError)
    async def storage(request: Request, error: OSError | SQLAlchemyError) -> JSONResponse:
        if getattr(error, "errno", None) in (ENOSPC, EDQUOT) or "disk is full" in str(error):
            return disk_full().response()
        if isinstance(error, StorageUnavailable) or database_unavailable(error):
            structlog.get_logger().warning("unavailable", path=request.url.path, reason=str(error).splitlines()[0])
            return unavailable().response()
        if error_code(getattr(error, "orig", None)) == UNTRANSLATABLE_CODE:
            return Problem(422, "invalid_request", "A text holds a character that cannot be kept (NUL).").response()
        return await unexpected(request, error)

    @app.exception_handler(Exception)
    async def unexpected(request: Request, error: Exception) -> JSONResponse:
        structlog.get_logger().error("unexpected_error", path=request.url.path, exc_info=error)
        return Problem(500, "internal_error", "Something went wrong inside the service; its log says what.").response()


def unavailable() -> Problem:
    """The database or the storage cannot be reached."""
    return Problem(
        503,
        "unavailable",
        "The database or the storage of the service does not answer: send the request again in a while.",
        headers={"Retry-After": str(RETRY_SECONDS)},
    )


def _methods(app: FastAPI, scope: Scope) -> list[str]:
    """The methods that an address offers, by whichever routes."""

    def offered(method: str) -> bool:
        return any(route.matches({**scope, "method": method})[0] is Match.FULL for route in app.router.routes)

    return [method for method in HTTP_METHODS if offered(method)]


def disk_full() -> Problem:
    """The disk has no room for what was sent."""
    return Problem(
        507,
        "disk_reserve",
        "The disk is nearly full: nothing new is accepted until space is freed. Delete jobs that are no longer needed, "
        "or lower GALATEA_DISK_RESERVE_MB.",
    )


def responses(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The problem answers of an endpoint, for the OpenAPI document."""
    content = {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/ProblemDocument"}}}
    return {
        status: {
            "description": phrase(status),
            "content": content,
            **({"headers": STATUS_HEADERS[status]} if status in STATUS_HEADERS else {}),
        }
        for status in statuses
    }


def phrase(status: int) -> str:
    """What a status means, in a word or two."""
    return STATUS_PHRASES.get(status) or HTTPStatus(status).phrase
