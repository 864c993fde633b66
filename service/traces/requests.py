"""Requests and their ids: in every answer, in every line of the log, and as one span of a trace each.

FastAPI can make spans of requests by itself. Those hold the whole address with its query, and so ids, names of files,
the tokens of public links and signatures: they stay switched off. Ours hold the route's template.
"""

from __future__ import annotations

import re

from opentelemetry.trace import INVALID_SPAN, Span, SpanKind, Tracer
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from structlog.contextvars import bind_contextvars, clear_contextvars

from service.ids import new_id
from service.traces.current import CurrentRequest, begin
from service.traces.tracer import fail, parent_of, trace_id

REQUEST_ID_PATTERN = "[A-Za-z0-9._-]{1,64}"
"""A request's id, as callers may give it."""

REQUEST_ID_HEADER = "X-Request-Id"

HTTP_METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
"""The methods of HTTP; a request by another one is told of as `_OTHER`."""

PROBE_PATHS = ("/healthz", "/readyz", "/metrics")
"""Asked every few seconds by machines: they would drown all else in the traces."""


class Requests:
    """Gives each request its id and its span. The outermost layer, so that no answer comes without."""

    def __init__(self, app: ASGIApp, tracer: Tracer):
        self.app = app
        self.tracer = tracer

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        given = headers.get(REQUEST_ID_HEADER, "")
        request = CurrentRequest(id=given if re.fullmatch(REQUEST_ID_PATTERN, given) else new_id())
        request.span = self._span(scope, headers)
        # Never taken back: the server logs in the same context after we are done. What a request before may have left
        # there (one that was sent together with this one) goes.
        clear_contextvars()
        begin(request)
        trace = trace_id(request.span)
        bind_contextvars(request=request.id, **({"trace": trace} if trace is not None else {}))
        ended = False

        def end(status: int | None) -> None:
            nonlocal ended
            if not ended:
                ended = True
                _end(scope, request, status)

        status: int | None = None

        async def send_marked(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                marked = MutableHeaders(scope=message)
                marked[REQUEST_ID_HEADER] = str(request.id)
                if marked.get("content-type", "").startswith("text/event-stream"):
                    end(status)  # it may last for hours, and says nothing of how quick the service is
            await send(message)

        try:
            await self.app(scope, receive, send_marked)
        finally:
            end(status)

    def _span(self, scope: Scope, headers: Headers) -> Span:
        if scope["path"] in PROBE_PATHS:
            return INVALID_SPAN
        method = _method(scope)
        attributes = {"http.request.method": method, "url.scheme": scope["scheme"]}
        parent = parent_of(headers.get("traceparent"))
        return self.tracer.start_span(method, parent, SpanKind.SERVER, attributes)


def _end(scope: Scope, request: CurrentRequest, status: int | None) -> None:
    span = request.span
    template = _template(scope)
    if template is not None:
        span.update_name(f"{_method(scope)} {template}")
        span.set_attribute("http.route", template)
    span.set_attribute("galatea.request", str(request.id))
    if status is not None:
        span.set_attribute("http.response.status_code", status)
    if status is None or status >= 500:
        fail(span, request.problem or "incomplete_response")
    elif request.problem is not None:
        span.set_attribute("error.type", request.problem)
    span.end()


def _method(scope: Scope) -> str:
    method: str = scope["method"]
    return method if method in HTTP_METHODS else "_OTHER"


def _template(scope: Scope) -> str | None:
    """The route's template with what it was included below, which is static; None where no route matched."""
    own = getattr(scope.get("route"), "path_format", None)
    if own is None:
        return None
    parts = scope["path"].split("/")
    return "/".join(parts[: len(parts) - own.count("/")]) + str(own)
