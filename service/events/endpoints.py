"""GET /jobs/{id}/events."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Query
from sse_starlette import EventSourceResponse
from starlette.responses import Response

from service.context import InContext
from service.events import repository
from service.events.stream import follow
from service.jobs.models import Status
from service.jobs.service import found
from service.problems import Problem, responses

router = APIRouter(prefix="/jobs", tags=["jobs"])

HEARTBEAT_SECONDS = 15


@router.get(
    "/{job_id}/events",
    operation_id="follow_job",
    response_class=EventSourceResponse,
    responses={
        200: {
            "description": "Server-sent events: `status`, `progress` and `artifact`",
            "content": {"text/event-stream": {}},
        },
        204: {"description": "The final event was already received: do not connect again"},
        **responses(404, 422),
    },
)
def follow_job(
    job_id: str,
    context: InContext,
    last_event_id: Annotated[str | None, Header(description="Resume after this event.")] = None,
    after: Annotated[str | None, Query(description="The same, for clients that cannot set headers.")] = None,
) -> Response:
    """The job's events from the beginning, or after `Last-Event-ID`; the stream ends after the final one."""
    given = last_event_id or after or "0"
    if not (given.isascii() and given.isdigit() and len(given) < 19):
        raise Problem(422, "invalid_event_id", "Last-Event-ID must be the id of an event of this job.")
    with context.database.read() as session:
        job = found(session, job_id)
        rest = repository.after(session, job_id, int(given), limit=1)
    if Status(job.status).final and not rest:
        # A browser connects again whenever a stream ends; this answer tells it to stop.
        return Response(status_code=204)
    return EventSourceResponse(
        follow(context, job_id, int(given)), ping=HEARTBEAT_SECONDS, headers={"Cache-Control": "no-store"}
    )
