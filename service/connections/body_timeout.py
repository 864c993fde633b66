"""How long a request's body may take: as long as it comes on, and as long as the service is to live.

A body has no time limit as a whole: a slow line may bring a large file. It has some seconds to stand still (`most`), which
it uses up while nothing comes and earns again by what comes, at the slowest rate that is worth waiting for. So a line that
brings a byte now and then does not hold on for good.
"""

from __future__ import annotations

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.connections.stopping import Stopping
from service.problems import Problem


class Interrupted(Problem):
    """Raised to whoever reads a body of which no more is waited for."""


class Stalled(Interrupted):
    """Nothing came for too long."""

    def __init__(self) -> None:
        detail = "The request's body stood still for too long, or came too slowly: send it again."
        super().__init__(408, "request_stalled", detail, headers={"Connection": "close"})


class Stopped(Interrupted):
    """The service is about to end."""

    def __init__(self) -> None:
        detail = "The service is stopping: send the request again in a while."
        super().__init__(503, "service_stopping", detail, headers={"Retry-After": "5", "Connection": "close"})


class BodyTimeout:
    """Ends bodies that do not come on, and at the service's end all of them; whatever request is cut short there is told
    so."""

    def __init__(self, app: ASGIApp, stopping: Stopping, most: float, rate: float):
        """`most` seconds may a body stand still; `rate` bytes earn it one of them again."""
        self.app = app
        self.stopping = stopping
        self.most = most
        self.rate = rate

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        answered = False

        async def send_noting(message: Message) -> None:
            nonlocal answered
            answered = True
            await send(message)

        body = _Body(self, receive)

        async def receive_in_time() -> Message:
            try:
                return await body.receive()
            except Interrupted:
                if answered:  # whoever only looks whether somebody is still there
                    return {"type": "http.disconnect"}
                raise

        try:
            await self.app(scope, receive_in_time, send_noting)
        except asyncio.CancelledError:
            if not self.stopping.begun:
                raise
            if not answered:
                await Stopped().response()(scope, receive, send)


class _Body:
    """A request's body as it comes in."""

    def __init__(self, patience: BodyTimeout, receive: Receive):
        self._patience = patience
        self._receive = receive
        self._left = patience.most
        self._complete = False

    async def receive(self) -> Message:
        """The next part. Raises `Interrupted`."""
        if self._complete:
            return await self._receive()
        loop, stopping = asyncio.get_running_loop(), self._patience.stopping
        began = loop.time()

        def interrupt() -> None:
            if not limit.expired():
                limit.reschedule(loop.time())

        try:
            # What has come already is taken even at the end.
            async with asyncio.timeout(0 if stopping.begun else self._left) as limit:
                with stopping.telling(interrupt):
                    message = await self._receive()
        except TimeoutError:
            raise (Stopped() if stopping.begun else Stalled()) from None
        earned = len(message.get("body", b"")) / self._patience.rate
        self._left = min(self._patience.most, self._left - (loop.time() - began) + earned)
        self._complete = not message.get("more_body", False)
        return message
