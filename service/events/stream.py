"""Following a job: its events as they come, from any point on, until the final one."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Sequence
from typing import Any

from anyio.to_thread import run_sync

from service.context import Context
from service.events import repository
from service.events.watch import Watch
from service.job_records import jobs
from service.tables.events import Event
from service.tables.jobs import Status


async def follow(
    context: Context, watch: Watch, job_id: str, events: Sequence[Event], after: int
) -> AsyncIterator[dict[str, Any]]:
    """The job's events that came after one, as the fields of a server-sent event: those that were found already, then
    what comes. Ends after the final one, when the job is deleted, or with the service."""
    with watch.follow(job_id) as follower:
        there = True
        while there:
            for event in events:
                after = event.id
                yield {"id": str(event.id), "event": event.type, "data": json.dumps(event.data)}
                if is_final(event):
                    return
            events, there = await run_sync(_look, context, job_id, after)
            if there and not events:
                await follower.wait()
                there = not watch.stopping.begun


def is_final(event: Event) -> bool:
    """Whether nothing can come after this event."""
    return event.type == "status" and Status(event.data["status"]).final


def _look(context: Context, job_id: str, after: int) -> tuple[Sequence[Event], bool]:
    with context.database.read() as session:
        events = repository.events_after(session, job_id, after)
        return events, bool(events) or jobs.get(session, job_id) is not None
