"""HTTP/1.1 as uvicorn speaks it by h11: strict, with bounds for connections that bring nothing, and with refusals of its
own that are problem documents too.

How long a body may take is not said here: see `service.connections.body_timeout`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, cast

import h11
import uvicorn

from service.connections.body_timeout import Stopped
from service.connections.connection_limit import MAX_PARTING, ConnectionLimit
from service.connections.sliced_reading import SlicedReading
from service.connections.strict import StrictConnection
from service.connections.transport import Transport
from service.connections.websocket import WebSocketConnection
from service.http import browser
from service.problems import Problem, phrase

MAX_REQUEST_HEAD_BYTES = 64 * 1024
"""How much of an address and headers may come without their end; what comes whole at once may be more."""

UNREAD_SECONDS = 30.0
"""How long a body may still come in that nobody asked for, once the request is answered: many clients read no answer
before they have sent all."""


class Config(uvicorn.Config):
    """A server's configuration, with the bounds of its connections.

    By h11, which is strict and bounded: the compiled parser takes headers without end, and refuses bodies of who offers
    an upgrade.
    """

    def __init__(
        self, app: Any, connection_limit: ConnectionLimit, head_seconds: float, send_seconds: float, **more: Any
    ):
        """`head_seconds` may the head of a request take, `send_seconds` may nothing be taken of an answer."""
        more = {"ws": WebSocketConnection, **more}
        super().__init__(app, http=Protocol, h11_max_incomplete_event_size=MAX_REQUEST_HEAD_BYTES, **more)
        self.connection_limit = connection_limit
        self.head_seconds = head_seconds
        self.send_seconds = send_seconds


class Protocol(SlicedReading):
    """One connection."""

    config: Config
    transport: Transport  # type: ignore[assignment]

    def __init__(self, *given: Any, **named: Any):
        super().__init__(*given, **named)
        self.conn = StrictConnection(h11.SERVER, MAX_REQUEST_HEAD_BYTES)
        self.address = ""
        self._timer: asyncio.TimerHandle | None = None
        self._timed = ""
        self._admitted = False
        self._heard = False  # something of the next head
        self._upgraded = False
        self._websocket: WebSocketConnection | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        guarded = Transport(transport, self._incoming, self.config.send_seconds)
        super().connection_made(cast(asyncio.Transport, guarded))
        self.address = self.client[0] if self.client else ""
        self._admitted = self.config.connection_limit.admit(self)
        if self._admitted:
            self._look()
        else:
            self._refuse(too_many_connections())

    def connection_lost(self, exc: Exception | None) -> None:
        self._time("", 0, lambda: None)
        self._count_out()
        if self.transport.parting:
            self.config.connection_limit.parting -= 1
        self.transport.rest()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        if self.transport.is_closing():
            self.transport.throw_away(data)
            return
        super().data_received(data)

    def on_response_complete(self) -> None:
        self._heard = bool(self.conn.trailing_data[0] or self._backlog)
        super().on_response_complete()
        self._look()

    def pause_writing(self) -> None:
        super().pause_writing()
        self.transport.watch_sending()

    def resume_writing(self) -> None:
        super().resume_writing()
        self.transport.rest()

    def _should_upgrade_to_ws(self) -> bool:
        """Whoever offers the upgrade without a handshake's key is answered as if it had not been offered."""
        return any(name == b"sec-websocket-key" for name, _ in self.headers)

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """Hand the connection over; it counts among the others until it is lost."""
        if self._backlog or self.conn.trailing_data[0]:  # before the handshake is answered nobody may go on
            self.send_400_response("")
            return
        self._time("", 0, lambda: None)
        self.config.connection_limit.busy(self)
        self._upgraded, self._heard = True, False
        self.connections.discard(self)
        app = cast(Any, self.config.loaded_app)
        websocket = WebSocketConnection(app, cast(Any, self.scope), self.transport, self._websocket_lost)
        self._websocket = websocket
        self.connections.add(cast(Any, websocket))
        self.transport.set_protocol(websocket)
        task = websocket.begin()
        task.add_done_callback(self.tasks.discard)
        self.tasks.add(task)

    def _websocket_lost(self, error: Exception | None) -> None:
        self.connections.discard(cast(Any, self._websocket))
        self.connection_lost(error)

    def make_room(self) -> None:
        """End: others have more use for the connection."""
        if self.cycle is None:  # somebody new, who is told
            self._refuse(too_many_connections())
        else:
            self._refuse_or_close(too_many_connections())

    def shutdown(self) -> None:
        """End with the service, as soon as the request under way is answered."""
        if self.transport.is_closing():
            return
        if self.cycle is None or self.cycle.response_complete:
            self._refuse_or_close(Stopped())
        else:
            self.cycle.keep_alive = False

    def send_400_response(self, msg: str) -> None:
        detail = "This is no HTTP/1.1 request, or its address and headers do not end within 64 KB."
        self._refuse(Problem(400, "malformed_request", detail))

    def _read_slice(self) -> None:
        self._heard = self._heard or bool(self._backlog)
        super()._read_slice()
        self._look()

    def _look(self) -> None:
        """What is waited for, and how long."""
        if self._upgraded:
            return
        if self.transport.is_closing():
            self._time("", 0, lambda: None)
            self._count_out()
        elif self.conn.their_state is h11.IDLE:
            self.config.connection_limit.wait(self)
            if self._heard or self.cycle is None:  # else it is idle, and uvicorn looks after that
                self._time("head", self.config.head_seconds, lambda: self._refuse_or_close(late_head()))
            else:
                self._time("", 0, lambda: None)
        else:
            self.config.connection_limit.busy(self)
            self._heard = False
            if self.conn.their_state is h11.SEND_BODY and self.cycle is not None and self.cycle.response_complete:
                self._time("unread", UNREAD_SECONDS, self.transport.abort)
            else:
                self._time("", 0, lambda: None)

    def _time(self, what: str, seconds: float, then: Callable[[], None]) -> None:
        """Have this done in so many seconds, unless something else is waited for before; only one thing ever is."""
        if what == self._timed:
            return
        self._timed = what
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if what:
            self._timer = self.loop.call_later(seconds, then)

    def _count_out(self) -> None:
        if self._admitted:
            self._admitted = False
            self.config.connection_limit.leave(self)

    def _incoming(self) -> bool:
        """Whether to close with care: something may still come in, and few connections are closed like that."""
        connection_limit = self.config.connection_limit
        careful = self.conn.their_state in (h11.SEND_BODY, h11.ERROR) or self._heard or not self._admitted
        if careful and connection_limit.parting < MAX_PARTING:
            connection_limit.parting += 1
            return True
        return False

    def _refuse_or_close(self, problem: Problem) -> None:
        """Answer what came of a head, and close; without a word where nothing came."""
        if self._heard:
            self._refuse(problem)
        else:
            self.transport.close()
            self._look()

    def _refuse(self, problem: Problem) -> None:
        """Answer in the service's place, and close."""
        self._unset_keepalive_if_required()
        if self.cycle is not None and not self.cycle.response_complete:  # whoever answers it is to let go
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        if self.conn.our_state is h11.SEND_BODY:  # an answer is cut short, and has to look like it
            self.transport.abort()
            return
        if self.conn.our_state in (h11.IDLE, h11.SEND_RESPONSE):  # else the request was answered already
            self._answer(problem)
        self.transport.close()
        self._look()

    def _answer(self, problem: Problem) -> None:
        problem.headers["Connection"] = "close"
        answer = problem.response()
        browser.add_security_headers(answer.headers)
        for event in (
            h11.Response(
                status_code=answer.status_code, headers=answer.raw_headers, reason=phrase(answer.status_code).encode()
            ),
            h11.Data(data=bytes(answer.body)),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")


def too_many_connections() -> Problem:
    """There are as many connections as there may be."""
    detail = "The service has as many connections as it can bear: try again in a moment."
    return Problem(503, "too_many_connections", detail, headers={"Retry-After": "5"})


def late_head() -> Problem:
    """The head of a request does not come."""
    return Problem(408, "head_too_slow", "The request's address and headers did not come in time: send it again.")
