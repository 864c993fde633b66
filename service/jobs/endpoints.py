"""POST /jobs, GET /jobs, GET /jobs/{id}, POST /jobs/{id}/cancel, DELETE /jobs/{id}."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Any

import anyio
from anyio.to_thread import run_sync
from fastapi import APIRouter, Header, Query, Request
from starlette.responses import Response

from service.artifacts import repository as artifacts
from service.context import Context, InContext
from service.disk import require_space
from service.ids import is_id
from service.jobs import repository, service
from service.jobs.models import Status
from service.jobs.request import submit_body
from service.jobs.schemas import JobIn, JobOut, JobPage
from service.problems import Problem, responses

router = APIRouter(prefix="/jobs", tags=["jobs"])

WAIT_POLL_SECONDS = 0.2

BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "application/json": {"schema": JobIn.model_json_schema()},
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "required": ["kind"],
                    "properties": {
                        "kind": {"type": "string"},
                        "options": {"type": "string", "contentMediaType": "application/json"},
                        "inputs": {"type": "string", "contentMediaType": "application/json"},
                        "metadata": {"type": "string", "contentMediaType": "application/json"},
                    },
                    "additionalProperties": {"type": "string", "format": "binary"},
                    "description": "Every other part is an input of that name: a file, or the text of an id or name.",
                }
            },
        },
    }
}


@router.post(
    "",
    status_code=202,
    operation_id="create_job",
    openapi_extra=BODY,
    responses=responses(409, 413, 415, 422, 507),
)
async def create_job(
    request: Request,
    response: Response,
    context: InContext,
    idempotency_key: Annotated[str | None, Header(min_length=1, max_length=255)] = None,
    prefer: Annotated[str | None, Header(description="`wait=SECONDS` holds the answer until the job ends.")] = None,
) -> JobOut:
    """Submit a job. The same `Idempotency-Key` with the same request makes one job, however often it is sent."""
    require_space(context.settings)
    job, replayed = await submit_body(request, context, idempotency_key)
    response.headers["Location"] = f"/v1/jobs/{job.id}"
    if replayed:
        response.headers["Idempotent-Replayed"] = "true"
    wait = re.search(r"(?:^|[\s,;])wait\s*=\s*\"?(\d{1,6})", prefer or "")
    if wait is None:
        return await run_sync(service.shown, context, job.id)
    seconds = min(float(wait[1]), context.settings.wait_seconds)
    response.headers["Preference-Applied"] = f"wait={seconds:g}"
    return await _wait(context, job.id, seconds)


@router.get("", operation_id="list_jobs", responses=responses(422))
def list_jobs(
    request: Request,
    response: Response,
    context: InContext,
    status: Annotated[list[Status], Query(description="One or several.")] = [],  # noqa: B006
    kind: Annotated[list[str], Query(description="One or several.")] = [],  # noqa: B006
    created_after: datetime | None = None,
    created_before: datetime | None = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: str | None = None,
) -> JobPage:
    """Jobs, newest first."""
    if cursor is not None and not is_id(cursor):
        raise Problem(422, "invalid_cursor", "The cursor is not one that a list gave: begin again without it.")
    with context.database.read() as session:
        jobs = repository.page(session, limit + 1, cursor, status, kind, created_after, created_before)
        shown = jobs[:limit]
        found = artifacts.of_jobs(session, [job.id for job in shown])
    next_cursor = shown[-1].id if len(jobs) > limit else None
    if next_cursor is not None:
        following = request.url.include_query_params(cursor=next_cursor)
        response.headers["Link"] = f'<{following.path}?{following.query}>; rel="next"'
    return JobPage(items=[JobOut.of(job, found[job.id]) for job in shown], next_cursor=next_cursor)


@router.get("/{job_id}", operation_id="get_job", responses=responses(404))
def get_job(job_id: str, context: InContext) -> JobOut:
    """A job."""
    return service.shown(context, job_id)


@router.post("/{job_id}/cancel", operation_id="cancel_job", responses=responses(404, 409))
def cancel_job(job_id: str, context: InContext) -> JobOut:
    """Cancel a job that has not ended."""
    service.cancel(context, job_id)
    return service.shown(context, job_id)


@router.delete("/{job_id}", status_code=204, operation_id="delete_job", responses=responses(404))
def delete_job(job_id: str, context: InContext) -> None:
    """Erase a job: its record, its artifacts, and its input files that nothing else uses."""
    service.delete(context, job_id)


async def _wait(context: Context, job_id: str, seconds: float) -> JobOut:
    deadline = anyio.current_time() + seconds
    while True:
        job = await run_sync(service.shown, context, job_id)
        if job.status.final or anyio.current_time() >= deadline:
            return job
        await anyio.sleep(WAIT_POLL_SECONDS)
