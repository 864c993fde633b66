"""GET /jobs/{id}/artifacts/{name} and /jobs/{id}/archive."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Query, Request
from sqlalchemy.orm import Session
from starlette.responses import Response, StreamingResponse

from service.artifacts.archive import zipped
from service.artifacts.naming import download_name
from service.auth.caller import Reader, identify
from service.auth.repository import get as get_key
from service.http.delivery import DELIVERED_IN_PARTS, deliver, stored_file
from service.job_records import artifacts as repository
from service.job_records import jobs
from service.job_records.owned import own_job
from service.job_records.signed_links import is_valid
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.jobs import Status

router = APIRouter(prefix="/jobs", tags=["jobs"])


@stored_file("/{job_id}/artifacts/{name}", router, "get_artifact", DELIVERED_IN_PARTS)
def get_artifact(
    job_id: str,
    name: str,
    request: Request,
    context: InContext,
    expires: Annotated[str | None, Query(description="As in the `signed_url` that a job gives.")] = None,
    signature: Annotated[str | None, Query(description="As in the `signed_url` that a job gives.")] = None,
) -> Response:
    """An artifact: whole, or the ranges asked for; unchanged ones are answered with 304."""
    with context.database.read() as session:
        if expires is not None and signature is not None:
            _require_good_link(session, job_id, name, expires, signature)
        else:
            caller = identify(request, context)
            caller.require("read")
            own_job(session, caller.owner, job_id)
        artifact = repository.get(session, job_id, name)
        job = jobs.get(session, job_id)
    if artifact is None or job is None:
        raise Problem(404, "artifact_not_found", "The job has no artifact of this name (yet).")
    stored = replace(artifact.stored, name=download_name(name, job.notes, job.inputs, job.options))
    return deliver(stored, context.storage, request)


@router.get(
    "/{job_id}/archive",
    operation_id="get_archive",
    response_class=StreamingResponse,
    responses={200: {"description": "A zip", "content": {"application/zip": {}}}, **responses(404, 409)},
)
def get_archive(job_id: str, caller: Reader, context: InContext) -> StreamingResponse:
    """All artifacts of a job that has ended, as one zip."""
    with context.database.read() as session:
        job = own_job(session, caller.owner, job_id)
        artifacts = repository.of_jobs(session, [job_id])[job_id]
    if not Status(job.status).final:
        raise Problem(409, "job_not_finished", f"The job is {job.status}: wait for its end.")
    headers = {"Content-Disposition": f'attachment; filename="{job.kind}-{job.id}.zip"', "Cache-Control": "private"}
    return StreamingResponse(zipped(artifacts, context.storage), media_type="application/zip", headers=headers)


def _require_good_link(session: Session, job_id: str, name: str, expires: str, signature: str) -> None:
    job = jobs.get(session, job_id)
    key = get_key(session, job.owner) if job is not None else None
    if key is None or not is_valid(key, job_id, name, expires, signature):
        raise Problem(403, "link_expired", "The link has expired, or is not one that the service gave: get a new one.")
