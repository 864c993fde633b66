"""The request that is answered right now, for whoever works on it, in whichever thread."""

from __future__ import annotations

from contextlib import AbstractContextManager
from contextvars import ContextVar
from dataclasses import dataclass

from opentelemetry.trace import INVALID_SPAN, Span
from structlog.contextvars import bound_contextvars

from service.traces.tracer import traceparent_of


@dataclass
class CurrentRequest:
    """A request under way."""

    id: str | None = None
    """None outside of requests."""
    span: Span = INVALID_SPAN
    problem: str | None = None
    """The code of the problem that it is answered with."""

    @property
    def traceparent(self) -> str | None:
        """How what it causes elsewhere finds its trace."""
        return traceparent_of(self.span)


_CURRENT: ContextVar[CurrentRequest | None] = ContextVar("current_request", default=None)


def current_request() -> CurrentRequest:
    """The request under way; an empty one outside of requests."""
    return _CURRENT.get() or CurrentRequest()


def begin(request: CurrentRequest) -> None:
    """Make it the request under way, for this task and all that it begins."""
    _CURRENT.set(request)


def origin_logged(request: str | None, trace: str | None, **more: object) -> AbstractContextManager[None]:
    """Have every line that is logged in a block tell which request and which trace it belongs to, and more."""
    origin = {"request": request, "trace": trace}
    return bound_contextvars(**{name: value for name, value in origin.items() if value is not None}, **more)
