"""Following a job: server-sent events, taken up where a broken line left them."""

from __future__ import annotations

import json
import time
from collections.abc import AsyncGenerator, AsyncIterable
from contextlib import aclosing
from math import inf
from typing import Any

import httpx

from galatea_client.errors import Unavailable
from galatea_client.models import Artifact, JobError, Model, Progress, Status
from galatea_client.transport import Transport

RECONNECT_SECONDS = 1.0
SILENCE_SECONDS = 60.0
"""The service sends a sign of life every 15 s: a line that is silent for this long is broken."""
MIN_ANSWER_SECONDS = 1.0
"""For an answer to begin, however little time is left."""


class StatusEvent(Model):
    """The job's status is another one; `error` says why it failed."""

    id: int
    status: Status
    error: JobError | None = None


class ProgressEvent(Model):
    """The job has come further."""

    id: int
    progress: Progress


class ArtifactEvent(Model):
    """An artifact is there."""

    id: int
    name: str
    artifact: Artifact


Event = StatusEvent | ProgressEvent | ArtifactEvent


async def follow(transport: Transport, job_id: str, after: int = 0, deadline: float = inf) -> AsyncGenerator[Event]:
    """The events of a job that came after one, as they come; ends after the final one.

    A broken line is taken up again after the last event, as often as it moves on in between.

    Raises
    ------
    TimeoutError : the job has not ended by the `deadline` (of `time.monotonic`). It is told then, or at the sign of life
        that follows.
    """
    failures = 0
    while True:
        try:
            async with aclosing(_once(transport, job_id, after, deadline)) as events:
                async for event in events:
                    yield event
                    failures, after = 0, event.id
                    if isinstance(event, StatusEvent) and event.status.final:
                        return
                return
        except (httpx.TransportError, Unavailable):
            _require_time(job_id, deadline)
            failures += 1
            if failures > transport.retries:
                raise
            await transport.line.sleep(RECONNECT_SECONDS)


async def _once(transport: Transport, job_id: str, after: int, deadline: float) -> AsyncGenerator[Event]:
    headers = {"Accept": "text/event-stream", **({"Last-Event-ID": str(after)} if after else {})}
    left = max(deadline - time.monotonic(), MIN_ANSWER_SECONDS)
    timeout = httpx.Timeout(30.0, read=min(left, SILENCE_SECONDS))
    async with transport.stream("follow_job", path={"job_id": job_id}, headers=headers, timeout=timeout) as response:
        if response.status_code == 204:
            return
        ended = False
        async for fields in _parse(_until(deadline, job_id, transport.line.lines(response))):
            event = _event(fields, transport.context)
            if event is not None:
                yield event
                ended = isinstance(event, StatusEvent) and event.status.final
        if not ended and await _there(transport, job_id):
            raise httpx.ReadError("the stream of events ended before the job did")


async def _there(transport: Transport, job_id: str) -> bool:
    """Whether the job is still there: raises `NotFound` where it was erased while it was followed."""
    return (await transport.call("get_job", path={"job_id": job_id})).is_success


async def _until(deadline: float, job_id: str, lines: AsyncIterable[str]) -> AsyncGenerator[str]:
    """The lines that come in time, signs of life among them."""
    async for line in lines:
        _require_time(job_id, deadline)
        yield line


def _require_time(job_id: str, deadline: float) -> None:
    if time.monotonic() > deadline:
        raise TimeoutError(f"the job {job_id} has not ended within the time that it was given")


async def _parse(lines: AsyncIterable[str]) -> AsyncGenerator[dict[str, str]]:
    """The fields of each event (the format of HTML's server-sent events; comments are signs of life)."""
    fields: dict[str, str] = {}
    async for line in lines:
        if line == "":
            if "data" in fields:
                yield fields
            fields = {}
        elif not line.startswith(":"):
            name, _, value = line.partition(":")
            value = value.removeprefix(" ")
            fields[name] = f"{fields[name]}\n{value}" if name == "data" and "data" in fields else value


def _event(fields: dict[str, str], context: dict[str, str]) -> Event | None:
    """The event that the fields tell of; None for one that this client does not know."""
    data: dict[str, Any] = json.loads(fields["data"])
    number = int(fields.get("id", "0"))
    match fields.get("event"):
        case "status":
            return StatusEvent.model_validate({"id": number, **data})
        case "progress":
            return ProgressEvent(id=number, progress=Progress.model_validate(data))
        case "artifact":
            return ArtifactEvent(id=number, name=data["name"], artifact=Artifact.model_validate(data, context=context))
    return None
