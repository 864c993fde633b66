"""Reading the body of POST /jobs and of POST /jobs/{id}/revisions: JSON, or a form that carries the files themselves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from anyio.to_thread import run_sync
from fastapi import Request
from pydantic import ValidationError

from service.auth.caller import Caller
from service.context import Context
from service.files import service as files
from service.files.intake import Form
from service.http.documents import parse_json
from service.http.json_bodies import JSON_TYPES, read_json
from service.jobs.schemas import JobIn, RevisionIn
from service.jobs.service import revise, submit
from service.problems import Problem, invalid
from service.tables.files import File
from service.tables.jobs import Job

JSON_PARTS = ("options", "metadata", "webhook_events")
TEXT_PARTS = ("kind", "webhook_url", "priority", "title")

Requested = TypeVar("Requested", JobIn, RevisionIn)
Accept = Callable[[Requested, Mapping[str, Sequence[File]]], tuple[Job, bool]]
"""What is done with a body and the files that came with it."""


async def submit_body(request: Request, context: Context, caller: Caller, key: str | None) -> tuple[Job, bool]:
    """Submit what the request's body asks for (see `submit`)."""

    def accept(requested: JobIn, uploaded: Mapping[str, Sequence[File]]) -> tuple[Job, bool]:
        return submit(context, caller.owner, requested, uploaded, key)

    return await _accepted(request, context, caller, JobIn, "inputs", accept)


async def revise_body(
    request: Request, context: Context, caller: Caller, job_id: str, key: str | None
) -> tuple[Job, bool]:
    """Submit a job again as the request's body asks for (see `revise`)."""

    def accept(requested: RevisionIn, uploaded: Mapping[str, Sequence[File]]) -> tuple[Job, bool]:
        return revise(context, caller.owner, job_id, requested, uploaded, key)

    return await _accepted(request, context, caller, RevisionIn, "corrections", accept)


def require_priority(caller: Caller, priority: str | None) -> None:
    """Raise a 403 problem where a caller asks to come before all others without being allowed to."""
    if priority == "high" and "admin" not in caller.scopes:
        raise Problem(
            403,
            "priority_not_allowed",
            "The priority “high” takes a key with the scope “admin”: use such a key, or submit the job as “normal”.",
        )


async def _accepted(
    request: Request, context: Context, caller: Caller, model: type[Requested], named: str, accept: Accept[Requested]
) -> tuple[Job, bool]:
    """Read a body; in a form, every part that is none of the others belongs to the object `named`."""
    content_type = request.headers.get("content-type", "").lower()
    if content_type.startswith("multipart/form-data"):
        return await _accepted_form(request, context, caller, model, named, accept)
    if content_type.split(";")[0].strip() not in JSON_TYPES:
        raise Problem(415, "body_type_unsupported", "Send the body as application/json or multipart/form-data.")
    requested = await run_sync(_validated, model, await read_json(request))
    require_priority(caller, requested.priority)
    return await run_sync(accept, requested, {})


async def _accepted_form(
    request: Request, context: Context, caller: Caller, model: type[Requested], named: str, accept: Accept[Requested]
) -> tuple[Job, bool]:
    texts = (named, *JSON_PARTS, *TEXT_PARTS)
    async with Form(request, context.settings, context.settings.upload_files, texts) as form:
        requested = await run_sync(_requested, model, named, form.fields)
        require_priority(caller, requested.priority)
        uploaded: dict[str, list[File]] = {}
        ids: list[str] = []
        try:
            for received in form.files:
                file = await run_sync(files.keep, context, caller.owner, received)
                uploaded.setdefault(received.part, []).append(file)
                ids.append(file.id)
            return await run_sync(accept, requested, uploaded)
        finally:
            # Those that no job uses: the job was refused, or an earlier request had made it.
            await run_sync(files.erase_unused, context, ids)


def _requested(model: type[Requested], named: str, fields: Mapping[str, str]) -> Requested:
    """What the texts of a form ask for. Raises a 422 problem."""
    parts: tuple[str, ...] = (named, *JSON_PARTS)
    document: dict[str, Any] = {name: parse_json(fields[name], name) for name in parts if name in fields}
    document |= {name: fields[name] for name in TEXT_PARTS if name in fields}
    # Any other text part names an input, so that `-F driver=idle` works beside `-F image=@photo.jpg`.
    texts = {name: text for name, text in fields.items() if name not in (*parts, *TEXT_PARTS)}
    if texts and isinstance(document.setdefault(named, {}), dict):
        document[named] |= texts
    return _validated(model, document)


def _validated(model: type[Requested], document: Any) -> Requested:
    try:
        return model.model_validate(document)
    except ValidationError as error:
        raise invalid(error, "invalid_request") from error
