"""The delivery of webhooks: what is due is claimed, sent, and settled.

Any number of workers may deliver at once. A slow receiver takes one of a worker's few places for a bounded time: an
attempt has a deadline, and only the first bytes of an answer are read. One host gets half of the places at most.
"""

from __future__ import annotations

import ssl
import time
from concurrent.futures import Future, ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from email.utils import parsedate_to_datetime
from random import Random

import httpx
import structlog
from opentelemetry.trace import Span, SpanKind

from service.context import Context
from service.outbound.address import AddressRefused
from service.outbound.client import client
from service.traces.current import origin_logged
from service.traces.tracer import fail, parent_of, trace_id
from service.webhooks import delivery_lease
from service.webhooks.delivery_lease import UNREADABLE_CODE, Claim, Outcome
from service.webhooks.signing import signed_headers
from worker.retry_db import retry_db

EXCERPT_BYTES = 1024


class WebhookSender:
    """Delivers what is due, whenever it is told to look."""

    def __init__(self, context: Context):
        settings = context.settings
        self._context = context
        self._client = client(
            settings, connect_seconds=settings.webhook_connect_seconds, seconds=settings.webhook_seconds
        )
        self._pool = ThreadPoolExecutor(settings.webhook_concurrency, thread_name_prefix="webhook")
        self._chance = Random()
        self._going_on: set[Future[None]] = set()

    def look(self, moment: datetime | None = None) -> set[Future[None]]:
        """Begin the attempts that are due now, or were it another moment, as far as there are places; those that go on
        then."""
        self._going_on = {attempt for attempt in self._going_on if not attempt.done()}
        with self._context.database.read() as session:
            if not delivery_lease.any_due(
                session, self._context.settings, moment or delivery_lease.database_now(session)
            ):
                return self._going_on
        while len(self._going_on) < self._context.settings.webhook_concurrency:
            with self._context.database.write() as session:
                began = moment or delivery_lease.database_now(
                    session
                )  # each time anew: a lease begins now, however late we are
                claim = delivery_lease.claim(session, self._context.settings, began)
            if claim is None:
                break
            self._going_on.add(self._pool.submit(self._deliver, claim, began))
        return self._going_on

    def close(self) -> None:
        """Begin nothing more. What goes on may end or not: its leases expire."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _deliver(self, claim: Claim, moment: datetime) -> None:
        host = httpx.URL(claim.url).host  # there may be secrets in the rest
        attributes = {"galatea.delivery": claim.delivery_id, "server.address": host}
        if claim.job_id is not None:
            attributes["galatea.job"] = claim.job_id
        tracer = self._context.traces.tracer
        span = tracer.start_span(f"webhook {claim.event}", parent_of(claim.trace), SpanKind.CLIENT, attributes)
        origin = {"job": claim.job_id} if claim.job_id is not None else {}
        with origin_logged(claim.request, trace_id(span), delivery=claim.delivery_id, host=host, **origin):
            try:
                self._attempt(claim, moment, span)
            finally:
                span.end()

    def _attempt(self, claim: Claim, moment: datetime, span: Span) -> None:
        log = structlog.get_logger()
        try:
            outcome = send(self._client, claim, moment)
            if outcome.status is not None:
                span.set_attribute("http.response.status_code", outcome.status)
            if outcome.code is not None:
                fail(span, outcome.code)
            retry_db(lambda: self._settle(claim, outcome, moment), self._context.settings.webhook_seconds)
        except Exception:
            fail(span, "internal_error")
            log.exception("webhook_not_settled")  # its lease expires, and it is tried again
            return
        log.info("webhook_attempted", outcome=outcome.code or "delivered", status=outcome.status)

    def _settle(self, claim: Claim, outcome: Outcome, moment: datetime) -> None:
        with self._context.database.write() as session:
            delivery_lease.settle(session, claim, outcome, moment + timedelta(seconds=outcome.seconds), self._chance)


def send(http: httpx.Client, claim: Claim, moment: datetime) -> Outcome:
    """Make one attempt. Whatever comes of it is an outcome, no error."""
    if claim.fault is not None:
        return Outcome(0.0, code=UNREADABLE_CODE, detail=claim.fault)
    began = time.monotonic()
    headers = signed_headers(claim.secrets, claim.delivery_id, moment, claim.body)
    headers["Content-Type"] = "application/json"
    try:
        with http.stream("POST", claim.url, content=claim.body.encode(), headers=headers) as response:
            excerpt = _excerpt(response)
            return _judged(response, excerpt, moment, time.monotonic() - began)
    except AddressRefused as refused:
        code, detail = "address_refused", str(refused)
    except (httpx.TimeoutException, httpx.InvalidURL, httpx.HTTPError) as error:
        code, detail = _why(error)
    return Outcome(time.monotonic() - began, code=code, detail=detail)


def _excerpt(response: httpx.Response) -> str:
    """The first bytes of the answer as text. An answer that breaks off, or never ends, is an answer all the same."""
    body = b""
    try:
        for piece in response.iter_raw():
            body += piece
            if len(body) >= EXCERPT_BYTES:
                break
    except httpx.HTTPError:
        pass
    return body[:EXCERPT_BYTES].decode(errors="replace").replace("\0", "\ufffd")


def _judged(response: httpx.Response, excerpt: str, moment: datetime, seconds: float) -> Outcome:
    status = response.status_code
    if response.is_success:
        return Outcome(seconds, status, excerpt)
    if response.has_redirect_location:
        to = response.headers["location"][:500]
        detail = f"It answered {status} and pointed to {to}: redirects are not followed, give that address itself."
        return Outcome(seconds, status, excerpt, "redirect", detail)
    detail = "It answered 410: it wants no more messages." if status == 410 else f"It answered {status}."
    after = _retry_after(response.headers.get("retry-after"), moment)
    return Outcome(seconds, status, excerpt, "refused", detail, after)


def _retry_after(header: str | None, moment: datetime) -> timedelta | None:
    """What `Retry-After` asks for: a number of seconds, or a date (RFC 9110, section 10.2.3)."""
    if header is None:
        return None
    if header.isascii() and header.isdigit():
        return timedelta(seconds=min(int(header[:9]), 10**7))
    try:
        until = parsedate_to_datetime(header)
    except ValueError:
        return None
    return max(until.replace(tzinfo=until.tzinfo or UTC) - moment, timedelta(0))


def _why(error: Exception) -> tuple[str, str]:
    if isinstance(error, httpx.TimeoutException):
        return "timeout", f"It did not answer in time ({str(error) or type(error).__name__})."
    if isinstance(error.__context__, ssl.SSLError) or "SSL" in str(error):
        return "tls", f"The encrypted connection could not be made: {error}."
    return "unreachable", f"It could not be reached, or ended the connection: {error}."
