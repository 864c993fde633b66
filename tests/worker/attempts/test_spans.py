"""The spans of an attempt, whatever its process tells."""

from __future__ import annotations

import time

import pytest
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import SimpleSpanProcessor
from opentelemetry.sdk.trace.export.in_memory_span_exporter import InMemorySpanExporter

from service.jobs.leases import Lease
from service.tables.jobs import Job
from worker.attempts.spans import MAX_ATTEMPT_STAGES, AttemptSpans


@pytest.fixture
def told() -> InMemorySpanExporter:
    return InMemorySpanExporter()


@pytest.fixture
def spans(told: InMemorySpanExporter) -> AttemptSpans:
    provider = TracerProvider()
    provider.add_span_processor(SimpleSpanProcessor(told))
    return AttemptSpans(provider.get_tracer("test"), Job(id="j" * 36, kind="tiny"), Lease("j" * 36, 1, 30))


@pytest.mark.parametrize(
    ("began", "ended"), [(0, 1e300), (-1e308, float("inf")), ("now", None), (10**40, -5), ([], {}), (True, False)]
)
def test_a_stage_lies_within_its_attempt(
    spans: AttemptSpans, told: InMemorySpanExporter, began: object, ended: object
) -> None:
    spans.stage({"event": "stage", "name": "measure", "turn": "began", "at": began})
    spans.stage({"event": "stage", "name": "measure", "turn": "ended", "at": ended})
    spans.end({"outcome": "succeeded"})
    stage, whole = told.get_finished_spans()
    assert stage.name == "stage measure" and stage.status.is_unset
    for moment in (stage.start_time, stage.end_time):
        assert whole.start_time <= moment <= whole.end_time


def test_a_process_that_never_stops_telling_is_heard_for_a_while(
    spans: AttemptSpans, told: InMemorySpanExporter
) -> None:
    for number in range(3 * MAX_ATTEMPT_STAGES):
        spans.stage({"event": "stage", "name": f"{number}" + "x" * 10_000, "turn": "began", "at": time.time()})
    spans.stage({"event": "stage"})
    spans.stage({"event": "stage", "name": "never begun", "turn": "ended"})
    spans.end({"outcome": "failed", "code": "c" * 1000})
    *stages, whole = told.get_finished_spans()
    assert len(stages) == MAX_ATTEMPT_STAGES and all(len(span.name) < 120 and not span.status.is_ok for span in stages)
    assert whole.attributes is not None and len(str(whole.attributes["error.type"])) == 64
