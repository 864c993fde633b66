"""POST /jobs, GET /jobs, GET, PATCH and DELETE /jobs/{id}, POST /jobs/{id}/cancel, /jobs/{id}/revisions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated, Any

import anyio
from anyio.to_thread import run_sync
from fastapi import APIRouter, Header, Query, Request
from starlette.responses import Response

from service.auth.caller import Reader, Submitter
from service.clock import Moment
from service.connections.stopping import InStopping, Stopping
from service.context import Context
from service.disk import require_space
from service.http.json_bodies import RequestModelRoute
from service.ids import LIKE_AN_ID, is_id
from service.job_records import jobs as repository
from service.job_records import owned
from service.job_records.schemas import JobOut, JobPage, JobTree
from service.job_records.search import search_words
from service.jobs import service
from service.jobs.request import JSON_PARTS, revise_body, submit_body
from service.jobs.schemas import JobChange
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.jobs import TITLE_CHARACTERS, TITLE_PATTERN, Job, Status

router = APIRouter(prefix="/jobs", tags=["jobs"], route_class=RequestModelRoute)

WAIT_POLL_SECONDS = 0.2
TITLE_SCHEMA = {"type": "string", "minLength": 1, "maxLength": TITLE_CHARACTERS, "pattern": TITLE_PATTERN}

IdempotencyKeyHeader = Annotated[str | None, Header(min_length=1, max_length=255)]
PreferHeader = Annotated[str | None, Header(description="`wait=SECONDS` holds the answer until the job ends.")]


def body(model: str, named: str, required: Sequence[str] = (), **properties: Any) -> dict[str, Any]:
    """What the OpenAPI document tells of a body: JSON, or a form of which every other part belongs to `named`."""
    parts = (named, *JSON_PARTS)
    form = {
        "type": "object",
        "required": list(required),
        "properties": {
            "priority": {"type": "string", "enum": ["high", "normal", "low"]},
            **{name: {"type": "object"} for name in parts if name != "webhook_events"},
            "webhook_url": {"type": "string"},
            "webhook_events": {"anyOf": [{"type": "array", "items": {"type": "string"}}, {"type": "null"}]},
            **properties,
        },
        "additionalProperties": {"type": "string", "format": "binary"},
        "description": f"Every other part is one of the {named} by that name: a file, or the text of an id or name.",
    }
    content = {
        "application/json": {"schema": {"$ref": f"#/components/schemas/{model}"}},
        "multipart/form-data": {
            "schema": form,
            "encoding": {name: {"contentType": "application/json"} for name in parts},
        },
    }
    return {"requestBody": {"required": True, "content": content}}


@router.post(
    "",
    status_code=202,
    operation_id="create_job",
    openapi_extra=body("JobIn", "inputs", ["kind"], kind={"type": "string"}, title=TITLE_SCHEMA),
    responses=responses(409, 413, 415, 422, 507),
)
async def create_job(
    request: Request,
    response: Response,
    caller: Submitter,
    context: InContext,
    stopping: InStopping,
    idempotency_key: IdempotencyKeyHeader = None,
    prefer: PreferHeader = None,
) -> JobOut:
    """Submit a job. The same `Idempotency-Key` with the same request makes one job, however often it is sent."""
    require_space(context.settings)
    job, replayed = await submit_body(request, context, caller, idempotency_key)
    return await _accepted(context, stopping, caller.owner, response, job, replayed, prefer)


@router.post(
    "/{job_id}/revisions",
    status_code=202,
    operation_id="revise_job",
    openapi_extra=body("RevisionIn", "corrections", metadata={"anyOf": [{"type": "object"}, {"type": "null"}]}),
    responses=responses(404, 409, 413, 415, 422, 507),
)
async def revise_job(
    job_id: str,
    request: Request,
    response: Response,
    caller: Submitter,
    context: InContext,
    stopping: InStopping,
    idempotency_key: IdempotencyKeyHeader = None,
    prefer: PreferHeader = None,
) -> JobOut:
    """Submit a job again with corrections or other options: only what depends on them is worked out anew."""
    require_space(context.settings)
    job, replayed = await revise_body(request, context, caller, job_id, idempotency_key)
    return await _accepted(context, stopping, caller.owner, response, job, replayed, prefer)


@router.get("/{job_id}/revisions", operation_id="list_revisions", responses=responses(404))
def list_revisions(job_id: str, caller: Reader, context: InContext) -> JobTree:
    """The job, what it revises, and all that revises it."""
    return owned.tree_view(context, caller.owner, job_id)


@router.get("", operation_id="list_jobs", responses=responses(422))
def list_jobs(
    request: Request,
    response: Response,
    caller: Reader,
    context: InContext,
    status: Annotated[list[Status], Query(description="One or several.", max_length=20)] = [],  # noqa: B006
    kind: Annotated[list[str], Query(description="One or several.", max_length=100)] = [],  # noqa: B006
    created_after: Moment | None = None,
    created_before: Moment | None = None,
    q: Annotated[
        str, Query(max_length=200, description="Words of title, kind, and names of files, drivers and motions.")
    ] = "",
    latest: Annotated[
        bool, Query(description="Of each work one job alone: its newest that the rest lets through.")
    ] = False,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(json_schema_extra=LIKE_AN_ID)] = None,
) -> JobPage:
    """Jobs, newest first."""
    if cursor is not None and not is_id(cursor):
        raise Problem(422, "invalid_cursor", "The cursor is not one that a list gave: begin again without it.")
    with context.database.read() as session:
        jobs = repository.page(
            session,
            caller.owner,
            limit + 1,
            cursor,
            status,
            kind,
            created_after,
            created_before,
            search_words(q),
            latest,
        )
        versions = repository.versions(session, caller.owner, {job.tree for job in jobs[:limit]})
        items = owned.job_views(context, session, caller.owner, jobs[:limit])
    next_cursor = items[-1].id if len(jobs) > limit else None
    if next_cursor is not None:
        following = request.url.include_query_params(cursor=next_cursor)
        response.headers["Link"] = f'<{following.path}?{following.query}>; rel="next"'
    return JobPage(items=items, versions=versions, next_cursor=next_cursor)


@router.get("/{job_id}", operation_id="get_job", responses=responses(404))
def get_job(job_id: str, caller: Reader, context: InContext) -> JobOut:
    """A job."""
    return owned.job_view(context, caller.owner, job_id)


@router.patch("/{job_id}", operation_id="change_job", responses=responses(404, 422))
def change_job(job_id: str, requested: JobChange, caller: Submitter, context: InContext) -> JobOut:
    """Give the work that a job is a version of a title, or take it away: all versions have the same."""
    service.retitle(context, caller.owner, job_id, requested.title)
    return owned.job_view(context, caller.owner, job_id)


@router.post("/{job_id}/cancel", operation_id="cancel_job", responses=responses(404, 409))
def cancel_job(job_id: str, caller: Submitter, context: InContext) -> JobOut:
    """Cancel a job that has not ended."""
    service.cancel(context, caller.owner, job_id)
    return owned.job_view(context, caller.owner, job_id)


@router.delete("/{job_id}", status_code=204, operation_id="delete_job", responses=responses(404))
def delete_job(job_id: str, caller: Submitter, context: InContext) -> None:
    """Erase a job: its record, its artifacts, and its input files that nothing else uses."""
    service.delete(context, caller.owner, job_id)


async def _accepted(
    context: Context,
    stopping: Stopping,
    owner: str,
    response: Response,
    job: Job,
    replayed: bool,
    prefer: str | None,
) -> JobOut:
    response.headers["Location"] = f"/v1/jobs/{job.id}"
    if replayed:
        response.headers["Idempotent-Replayed"] = "true"
    wait = re.search(r"(?:^|[\s,;])wait\s*=\s*\"?(\d{1,6})", prefer or "")
    if wait is None and not replayed:
        place = await run_sync(owned.queue_place, context, job)
        return JobOut.of(job, [], queue_position=place)  # it has only just been written
    if wait is None:
        return await run_sync(owned.job_view, context, owner, job.id)
    seconds = min(float(wait[1]), context.settings.wait_seconds)
    response.headers["Preference-Applied"] = f"wait={seconds:g}"
    return await _wait(context, stopping, owner, job.id, seconds)


async def _wait(context: Context, stopping: Stopping, owner: str, job_id: str, seconds: float) -> JobOut:
    """The job once it has ended, or the time is over, or the service stops: it was accepted, whatever becomes of us."""
    deadline = anyio.current_time() + seconds
    while True:
        job = await run_sync(owned.job_view, context, owner, job_id)
        if job.status.final or stopping.begun or anyio.current_time() >= deadline:
            return job
        await stopping.sleep(WAIT_POLL_SECONDS)
