"""Traces by OpenTelemetry: spans that go to the collector of the settings, or nowhere.

Only the API of OpenTelemetry is used everywhere: its spans do nothing where traces are switched off. What sends spans
takes a while to import, and is imported only where traces are switched on.
"""

from __future__ import annotations

from opentelemetry.context import Context
from opentelemetry.trace import NoOpTracer, Span, StatusCode, Tracer, set_span_in_context
from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator


class Traces:
    """What makes spans in this process, and sends them."""

    def __init__(self, url: str | None, part: str):
        """`url` is the collector's address for OTLP over HTTP, None for no traces; `part` is what this process is."""
        self.tracer: Tracer = NoOpTracer()
        self._sender = None
        if url is not None:
            from service.traces.sender import Sender

            self._sender = Sender(url, f"galatea-{part}")
            self.tracer = self._sender.tracer

    def close(self) -> None:
        """Send what is left, unless the collector does not take it within a few seconds."""
        if self._sender is not None:
            self._sender.close()


def parent_of(traceparent: str | None) -> Context:
    """Where a new span belongs: below the span that a `traceparent` names (W3C Trace Context), or below none."""
    return TraceContextTextMapPropagator().extract({"traceparent": traceparent or ""}, context=Context())


def child_context(span: Span) -> Context:
    """Where a new span belongs that is a part of this one."""
    return set_span_in_context(span, Context())


def traceparent_of(span: Span) -> str | None:
    """The name under which other processes know a span; None if it belongs to no trace."""
    carrier: dict[str, str] = {}
    TraceContextTextMapPropagator().inject(carrier, context=child_context(span))
    return carrier.get("traceparent")


def trace_id(span: Span) -> str | None:
    """The trace that a span belongs to (32 hexadecimal digits), if any."""
    context = span.get_span_context()
    return f"{context.trace_id:032x}" if context.is_valid else None


def fail(span: Span, code: str | None = None) -> None:
    """Note that what a span stands for failed, and the code of why; never the detail, which may be private."""
    span.set_status(StatusCode.ERROR)
    if code is not None:
        span.set_attribute("error.type", code[:64])
