"""Errors as the API tells them: RFC 9457 problem documents with a stable `code`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from http import HTTPStatus
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel, ValidationError
from starlette.responses import JSONResponse

from engine.unknown_options import with_suggestions
from service.traces.current import current_request

MEDIA_TYPE = "application/problem+json"
RETRY_SECONDS = 5
"""After how long it is worth trying again where something does not answer."""
MAX_ERRORS = 10
"""How many wrong fields are told of in one answer: a stranger may send many thousands."""
MAX_POINTER_CHARACTERS = 300
"""Characters of an answer's pointer, at most: it may repeat what a request held."""
MAX_DETAIL_CHARACTERS = 2000
"""Characters of an answer's detail, at most: it may repeat what a request held."""
PYDANTIC_UNKNOWN_FIELD, MAX_NAME_CHARACTERS = "Extra inputs are not permitted", 80
"""What pydantic says of a field that a document does not have, and characters of its name that are repeated."""

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

    return [FieldError(pointer=pointer(e["loc"]), code=e["type"], detail=_detail(e)) for e in errors[:MAX_ERRORS]]


def _detail(error: Any) -> str:
    """What is said of an error of pydantic's, whose words for a field that is unknown do not say what to do."""
    if error["msg"] == PYDANTIC_UNKNOWN_FIELD:
        name = _cut(str(error["loc"][-1]), MAX_NAME_CHARACTERS)
        return f"There is no such field as {name}: leave it out, or look its name up in /v1/openapi.json."
    return str(error["msg"])


def invalid_fields(code: str, errors: Sequence[FieldError], count: int) -> Problem:
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
    return invalid_fields(code, field_errors(told, prefix, elsewhere), count)


def unavailable() -> Problem:
    """The database or the storage cannot be reached."""
    return Problem(
        503,
        "unavailable",
        "The database or the storage of the service does not answer: send the request again in a while.",
        headers={"Retry-After": str(RETRY_SECONDS)},
    )


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
