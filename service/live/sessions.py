"""The live portraits of this machine: as many as it has cores, each its owner's."""

from __future__ import annotations

import asyncio
import os
import secrets
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from service.connections.stopping import Stopping
from service.context import Context
from service.ids import new_id
from service.live.process import LiveOrder, StartLive
from service.live.session import LiveSession
from service.problems import Problem

KEPT_SECONDS = 30.0
"""How long a session is known after its end, so that whoever comes late learns why."""


class LiveSessions:
    """Of the event loop's thread alone."""

    def __init__(self, context: Context, stopping: Stopping, start: StartLive | None):
        """`start` starts a process; without one there are no live portraits."""
        self._context, self._start = context, start
        streams = context.settings.live_streams
        self.most = 0 if start is None else len(os.sched_getaffinity(0)) if streams is None else streams
        self._sessions: dict[str, LiveSession] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        stopping.tell(self._stop)

    def under_way(self, owner: str | None = None) -> int:
        """How many there are, of an owner or of all."""
        return sum(one.ended is None and owner in (None, one.owner) for one in self._sessions.values())

    def require_room(self) -> None:
        """Raise a 503 problem where there is no room for one more."""
        if self.most == 0:
            raise Problem(503, "live_off", "Live portraits are switched off on this machine (GALATEA_LIVE_STREAMS).")
        if self.under_way() >= self.most:
            raise Problem(
                503,
                "live_busy",
                f"As many live portraits are under way as this machine can bear ({self.most}): end one, or try again later.",
                headers={"Retry-After": "10"},
            )

    def begin(self, owner: str, key: str, order: LiveOrder) -> LiveSession:
        """Begin one with the picture that the storage has under a `key`; `order.image` is where a copy of it goes in a folder
        of its own. Raises a 503 problem."""
        self.require_room()
        session = LiveSession(new_id(), owner, secrets.token_urlsafe(24), self._context.settings)
        moment = time.monotonic()
        self._sessions = {
            id: one for id, one in self._sessions.items() if one.ended is None or moment - one.ended_at < KEPT_SECONDS
        }
        self._sessions[session.id] = session
        task = asyncio.get_running_loop().create_task(self._run(session, key, order))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return session

    def find(self, id: str, owner: str) -> LiveSession:
        """The owner's session, or a 404 problem."""
        session = self._sessions.get(id)
        if session is None or session.owner != owner:
            raise missing()
        return session

    def find_to_view(self, id: str, token: str) -> LiveSession:
        """The session that a token lets look at, or a 404 problem."""
        session = self._sessions.get(id)
        if session is None or not secrets.compare_digest(token.encode(), session.view_token.encode()):
            raise missing()
        return session

    async def _run(self, session: LiveSession, key: str, order: LiveOrder) -> None:
        assert self._start is not None
        with TemporaryDirectory(prefix="live-", dir=self._context.settings.data_dir) as folder:
            try:
                fetch = self._context.storage.fetch
                image = await asyncio.to_thread(fetch, key, Path(folder) / order.image)
            except OSError:
                session.end("live_failed")
                return
            await session.run(self._start, LiveOrder(image, order.options, order.frame_pixels))

    def _stop(self) -> None:
        for session in self._sessions.values():
            session.end("service_stopping")


def missing() -> Problem:
    return Problem(404, "live_not_found", "There is no such live portrait: it has ended, or it never was.")
