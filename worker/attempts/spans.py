"""The spans of an attempt: one of the whole, and below it one of each stage and of each fetch.

All are made by the worker: a job's process has no network. What that tells of its stages is bounded and put in its
place, for it may be in a stranger's hands.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from opentelemetry.trace import Span, SpanKind, Tracer

from service.jobs.leases import Lease
from service.tables.jobs import Job
from service.traces.tracer import child_context, fail, parent_of, trace_id

MAX_ATTEMPT_STAGES = 200
"""The most stages of one attempt; what more it tells of is left out."""

NANOSECONDS_PER_SECOND = 1_000_000_000


class AttemptSpans:
    """Begins with the attempt; `end` is to be called once it is over."""

    def __init__(self, tracer: Tracer, job: Job, lease: Lease):
        self._tracer = tracer
        self._began = time.time_ns()
        attributes: dict[str, str | int] = {
            "galatea.job": job.id,
            "galatea.kind": job.kind,
            "galatea.attempt": lease.token,
        }
        if job.request is not None:
            attributes["galatea.request"] = job.request
        self._whole = tracer.start_span(
            f"job {job.kind}", parent_of(job.trace), SpanKind.CONSUMER, attributes, start_time=self._began
        )
        self._stages: dict[str, Span] = {}
        self._told = 0

    @property
    def trace_id(self) -> str | None:
        return trace_id(self._whole)

    def stage(self, event: Mapping[str, Any]) -> None:
        """A stage began, ended or broke off, as the job's process says."""
        name, at = str(event.get("name"))[:100], self._moment(event.get("at"))
        if (before := self._stages.pop(name, None)) is not None:
            if event.get("turn") != "ended":
                fail(before)
            before.end(at)
        if event.get("turn") == "began" and self._told < MAX_ATTEMPT_STAGES:
            self._told += 1
            self._stages[name] = self._tracer.start_span(
                f"stage {name}", child_context(self._whole), attributes={"galatea.stage": name}, start_time=at
            )

    @contextmanager
    def fetching(self, url: str) -> Iterator[Span]:
        """The fetch of one input. Of its address, which may hold secrets, only the host is told."""
        attributes: dict[str, str | int] = {"server.address": urlsplit(url).hostname or ""}
        span = self._tracer.start_span("fetch", child_context(self._whole), SpanKind.CLIENT, attributes)
        try:
            yield span
        finally:
            span.end()

    def end(self, verdict: Mapping[str, Any]) -> None:
        """How the attempt ended (see `Attempt`); a stage that was under way broke off with it."""
        moment = time.time_ns()
        for span in self._stages.values():
            fail(span)
            span.end(moment)
        outcome = str(verdict["outcome"])
        self._whole.set_attribute("galatea.outcome", outcome)
        if outcome in ("failed", "crashed"):
            fail(self._whole, str(verdict.get("code") or outcome))
        self._whole.end(moment)

    def _moment(self, at: object) -> int:
        """A moment that the process tells (seconds since 1970), in nanoseconds and within the attempt."""
        present = time.time_ns()
        seconds = at if isinstance(at, int | float) else present / NANOSECONDS_PER_SECOND
        return int(min(max(seconds * NANOSECONDS_PER_SECOND, self._began), present))
