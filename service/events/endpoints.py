"""GET /jobs/{id}/events."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Header, Query
from sse_starlette import EventSourceResponse
from starlette.responses import Response

from service.auth.caller import Reader
from service.events import repository
from service.events.stream import follow
from service.events.watch import InWatch
from service.job_records.owned import own_job
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.jobs import Status

router = APIRouter(prefix="/jobs", tags=["jobs"])

HEARTBEAT_SECONDS = 15
STREAM_STOP_SECONDS = 2
"""How long a stream may take to end by itself when the service does."""
AN_EVENT_ID: dict[str, Any] = {"pattern": "^[0-9]{1,18}$"}


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
    caller: Reader,
    context: InContext,
    watch: InWatch,
    last_event_id: Annotated[
        str | None, Header(description="Resume after this event.", json_schema_extra=AN_EVENT_ID)
    ] = None,
    after: Annotated[
        str | None, Query(description="The same, for clients that cannot set headers.", json_schema_extra=AN_EVENT_ID)
    ] = None,
) -> Response:
    """The job's events from the beginning, or after `Last-Event-ID`; the stream ends after the final one."""
    given = [value for value in (last_event_id, after, "0") if value is not None]
    if not all(value.isascii() and value.isdigit() and len(value) < 19 for value in given):
        raise Problem(422, "invalid_event_id", "Last-Event-ID must be the id of an event of this job.")
    seen = int(given[0])
    with context.database.read() as session:
        job = own_job(session, caller.owner, job_id)
        events = repository.events_after(session, job_id, seen)
    if Status(job.status).final and not events:
        # A browser connects again whenever a stream ends; this answer tells it to stop.
        return Response(status_code=204)
    return EventSourceResponse(
        follow(context, watch, job_id, events, seen),
        ping=HEARTBEAT_SECONDS,
        headers={"Cache-Control": "no-store"},
        shutdown_grace_period=STREAM_STOP_SECONDS,
    )
