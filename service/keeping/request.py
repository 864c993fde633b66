"""The bodies by which something is kept: a form with the file itself, or JSON with the id of an uploaded one."""

from __future__ import annotations

from typing import Annotated, Any

from anyio.to_thread import run_sync
from fastapi import Request
from pydantic import BaseModel, Field, ValidationError
from pydantic.config import JsonDict

from service.auth.caller import Caller
from service.context import Context
from service.disk import require_space
from service.files import service as files
from service.files.intake import Form
from service.http.json_bodies import JSON_TYPES, read_json
from service.http.request_models import REQUEST_MODEL
from service.ids import LIKE_AN_ID
from service.keeping import service
from service.libraries.library import Library
from service.problems import Problem, invalid

NAME_SCHEMA: JsonDict = {"minLength": 1, "maxLength": 63, "pattern": f"^{service.NAME_PATTERN.pattern}$"}
"""What the OpenAPI document tells of a name; `require_free_name` checks it, so that the error has its code."""


class KeptIn(BaseModel):
    """What is to be kept."""

    model_config = REQUEST_MODEL

    name: str
    file: str


class KeptChange(BaseModel):
    """What is to be different about something that is kept."""

    model_config = REQUEST_MODEL

    name: Annotated[str, Field(json_schema_extra=NAME_SCHEMA)]
    """Its new name."""


def body(media_types: str) -> dict[str, Any]:
    """What the OpenAPI document tells of such a body; `media_types` as they stand in an `Accept`."""

    def schema(file: dict[str, Any]) -> dict[str, Any]:
        properties = {"name": {"type": "string", **NAME_SCHEMA}, "file": {"type": "string", **file}}
        return {"type": "object", "required": ["name", "file"], "properties": properties, "additionalProperties": False}

    form = {"schema": schema({"format": "binary"}), "encoding": {"file": {"contentType": media_types}}}
    json = {"schema": schema({**LIKE_AN_ID, "description": "The id of an uploaded file."})}
    return {"requestBody": {"required": True, "content": {"multipart/form-data": form, "application/json": json}}}


async def keep_body(request: Request, context: Context, caller: Caller, library: Library) -> str:
    """Keep what a request's body holds. Returns its name; raises `Problem`."""
    require_space(context.settings)
    content_type = request.headers.get("content-type", "").lower()
    if content_type.startswith("multipart/form-data"):
        return await _keep_form(request, context, caller.owner, library)
    if content_type.split(";")[0].strip() not in JSON_TYPES:
        raise Problem(415, "body_type_unsupported", "Send the body as multipart/form-data or application/json.")
    try:
        requested = KeptIn.model_validate(await read_json(request))
    except ValidationError as error:
        raise invalid(error, "invalid_request") from error
    await run_sync(service.require_free_name, context, library, caller.owner, requested.name)
    await run_sync(service.keep, context, library, caller.owner, requested.name, requested.file)
    return requested.name


async def _keep_form(request: Request, context: Context, owner: str, library: Library) -> str:
    async with Form(request, context.settings, most_files=1, texts=("name",), files=("file",)) as form:
        name = form.fields.get("name", "")
        await run_sync(service.require_free_name, context, library, owner, name)
        if not form.files:
            raise Problem(422, "file_missing", f"Send {library.media} as the part “file” of the multipart body.")
        service.require_media(library, form.files[0].content_type)
        file = await run_sync(files.keep, context, owner, form.files[0])
        try:
            await run_sync(service.keep, context, library, owner, name, file.id)
        finally:
            await run_sync(files.erase_unused, context, [file.id])
    return name
