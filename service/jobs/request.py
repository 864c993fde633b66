"""Reading the body of POST /jobs: JSON, or a form that carries the files themselves."""

from __future__ import annotations

import json
from typing import Any

from anyio.to_thread import run_sync
from fastapi import Request
from pydantic import ValidationError

from service.context import Context
from service.files import service as files
from service.files.intake import FIELD_BYTES, Form
from service.files.models import File
from service.jobs.models import Job
from service.jobs.schemas import JobIn
from service.jobs.service import submit
from service.problems import Problem, invalid

JSON_PARTS = ("inputs", "options", "metadata")
TEXT_PARTS = ("kind", "webhook_url")


async def submit_body(request: Request, context: Context, key: str | None) -> tuple[Job, bool]:
    """Submit what the request's body asks for (see `submit`)."""
    content_type = request.headers.get("content-type", "").lower()
    if content_type.startswith("multipart/form-data"):
        return await _submit_form(request, context, key)
    if content_type.split(";")[0].strip() not in ("", "application/json"):
        raise Problem(415, "body_type_unsupported", "Send the body as application/json or multipart/form-data.")
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > FIELD_BYTES:
            raise Problem(413, "request_too_large", f"The JSON body may have {FIELD_BYTES} bytes at most.")
    return await run_sync(submit, context, _job_in(_json(body, "The body")), {}, key)


async def _submit_form(request: Request, context: Context, key: str | None) -> tuple[Job, bool]:
    async with Form(request, context.settings, context.settings.upload_files) as form:
        document: dict[str, Any] = {name: _json(form.fields[name], name) for name in JSON_PARTS if name in form.fields}
        document |= {name: form.fields[name] for name in TEXT_PARTS if name in form.fields}
        # Any other text part names an input, so that `-F driver=idle` works beside `-F image=@photo.jpg`.
        texts = {name: text for name, text in form.fields.items() if name not in (*JSON_PARTS, *TEXT_PARTS)}
        if texts and isinstance(document.setdefault("inputs", {}), dict):
            document["inputs"] |= texts
        asked = _job_in(document)
        uploaded: dict[str, list[File]] = {}
        ids: list[str] = []
        try:
            for received in form.files:
                file = await run_sync(files.keep, context, received)
                uploaded.setdefault(received.part, []).append(file)
                ids.append(file.id)
            return await run_sync(submit, context, asked, uploaded, key)
        finally:
            # Those that no job uses: the job was refused, or an earlier request had made it.
            await run_sync(files.erase_unused, context, ids)


def _json(text: str | bytes, what: str) -> Any:
    try:
        return json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError):
        raise Problem(422, "invalid_json", f"{what} is not valid JSON.") from None


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no JSON")


def _job_in(document: Any) -> JobIn:
    try:
        return JobIn.model_validate(document)
    except ValidationError as error:
        raise invalid(error, "invalid_request") from error
