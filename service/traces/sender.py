"""Sending spans to a collector, in batches and from a thread of its own: one that is away costs spans and nothing else.

The variables of OpenTelemetry's SDK hold where no setting of ours does: `OTEL_EXPORTER_OTLP_HEADERS`,
`OTEL_TRACES_SAMPLER`, `OTEL_RESOURCE_ATTRIBUTES`, `OTEL_BSP_SCHEDULE_DELAY` and so on.
"""

from __future__ import annotations

import os
import socket
import threading

from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
from opentelemetry.sdk.resources import Resource
from opentelemetry.sdk.trace import TracerProvider
from opentelemetry.sdk.trace.export import BatchSpanProcessor

import engine

FAREWELL_SECONDS = 2.0
"""How long the last spans may take when the process ends; a worker that ends has five seconds in all."""


class Sender:
    """Sends all spans of `tracer`."""

    def __init__(self, url: str, name: str):
        """`name` is what the process is called in traces."""
        self._exporter = OTLPSpanExporter(url)
        self._batches = BatchSpanProcessor(self._exporter)
        resource = Resource.create(
            {
                "service.name": name,
                "service.version": engine.__version__,
                "service.instance.id": f"{socket.gethostname()}:{os.getpid()}",
            }
        )
        # Its own farewell would wait half a minute for a collector that is away.
        provider = TracerProvider(resource=resource, shutdown_on_exit=False)
        provider.add_span_processor(self._batches)
        self.tracer = provider.get_tracer("galatea", engine.__version__)

    def close(self) -> None:
        closing = threading.Thread(target=self._batches.shutdown, name="traces", daemon=True)
        closing.start()
        closing.join(FAREWELL_SECONDS)
        if closing.is_alive():
            self._exporter.shutdown()  # no further tries
