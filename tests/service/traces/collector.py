"""A collector of traces on loopback that speaks OTLP over HTTP and remembers what came."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from opentelemetry.proto.collector.trace.v1.trace_service_pb2 import ExportTraceServiceRequest
from opentelemetry.proto.trace.v1.trace_pb2 import Span, Status
from running import eventually


@dataclass(frozen=True)
class Told:
    """A span that came: ids in hexadecimal digits, times in nanoseconds since 1970."""

    service: str
    name: str
    trace: str
    id: str
    parent: str
    kind: str
    began: int
    ended: int
    broke: bool
    attributes: dict[str, Any]


class Collector(ThreadingHTTPServer):
    """Listens from the moment it is made."""

    daemon_threads = True

    def __init__(self) -> None:
        self.spans: list[Told] = []
        self.bodies: list[bytes] = []
        collector = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                collector.bodies.append(body)
                collector.spans.extend(decoded(body))
                self.send_response(200)
                self.send_header("Content-Length", "0")
                self.end_headers()

            def log_message(self, *_: object) -> None:
                """Not to the tests' output."""

        super().__init__(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server_address[1]}/v1/traces"
        threading.Thread(target=self.serve_forever, args=(0.05,), daemon=True).start()

    def of(self, trace: str) -> list[Told]:
        """The spans of a trace, in the order in which they began."""
        return sorted((span for span in self.spans if span.trace == trace), key=lambda span: span.began)

    def until(self, true: Callable[[list[Told]], bool], what: str, trace: str) -> list[Told]:
        """Wait until this is true of a trace's spans; the spans."""
        eventually(lambda: true(self.of(trace)), what)
        return self.of(trace)

    def close(self) -> None:
        self.shutdown()
        self.server_close()


def decoded(body: bytes) -> list[Told]:
    """The spans of an export."""
    told = []
    for resource in ExportTraceServiceRequest.FromString(body).resource_spans:
        name = _values(resource.resource.attributes)["service.name"]
        told += [_told(name, span) for scope in resource.scope_spans for span in scope.spans]
    return told


def _told(service: str, span: Span) -> Told:
    assert not span.status.message and not span.events, "what went wrong is told by its code alone"
    return Told(
        service=service,
        name=span.name,
        trace=span.trace_id.hex(),
        id=span.span_id.hex(),
        parent=span.parent_span_id.hex(),
        kind=Span.SpanKind.Name(span.kind).removeprefix("SPAN_KIND_"),
        began=span.start_time_unix_nano,
        ended=span.end_time_unix_nano,
        broke=span.status.code == Status.STATUS_CODE_ERROR,
        attributes=_values(span.attributes),
    )


def _values(attributes: Any) -> dict[str, Any]:
    return {one.key: getattr(one.value, one.value.WhichOneof("value")) for one in attributes}
