"""One look at the database for all who follow a job in this process: whoever's job changed is woken.

Followers that each asked for themselves would ask hundreds of times a second when hundreds follow.
"""

from __future__ import annotations

import asyncio
from collections import defaultdict
from contextlib import suppress
from typing import Annotated

import structlog
from anyio.to_thread import run_sync
from fastapi import Depends, Request
from sqlalchemy.exc import SQLAlchemyError

from service.connections.stopping import Stopping
from service.context import Context
from service.events import repository

EVENT_POLL_SECONDS = 0.25
LATE_EVENT_IDS = 100
"""Ids before the newest that are looked at again: where several write at once, a smaller one may show later."""

RECHECK_SECONDS = 5.0
"""After this long a follower looks for itself, come what may: its job may be gone, which is no event."""


class Watch:
    """Wakes the followers of jobs. It looks only while somebody follows."""

    def __init__(self, context: Context, stopping: Stopping):
        self.stopping = stopping
        self._context = context
        self._following: defaultdict[str, set[asyncio.Event]] = defaultdict(set)
        self._task: asyncio.Task[None] | None = None
        stopping.tell(self._wake_all)

    def follow(self, job_id: str) -> Follower:
        """Begin to follow a job: from now on no event of it is missed."""
        follower = Follower(self, job_id)
        self._following[job_id].add(follower.changed)
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._look())
        return follower

    def leave(self, follower: Follower) -> None:
        """End to follow."""
        there = self._following[follower.job_id]
        there.discard(follower.changed)
        if not there:
            del self._following[follower.job_id]

    def _wake_all(self) -> None:
        for followers in self._following.values():
            for changed in followers:
                changed.set()

    async def _look(self) -> None:
        newest: int | None = None
        seen: set[int] = set()
        while self._following:
            try:
                events = await run_sync(self._since, newest)
            except SQLAlchemyError as error:  # a lock, a full disk: it passes
                structlog.get_logger().warning("events_not_read", reason=str(error))
            else:
                fresh = [(number, job) for number, job in events if number not in seen]
                newest = max((number for number, _ in events), default=newest or 0)
                seen = {number for number, _ in events}
                for job in {job for _, job in fresh}:
                    for changed in self._following.get(job, ()):
                        changed.set()
            await asyncio.sleep(EVENT_POLL_SECONDS)

    def _since(self, newest: int | None) -> list[tuple[int, str]]:
        with self._context.database.read() as session:
            if newest is None:
                newest = repository.newest(session)
            return repository.jobs_since(session, newest - LATE_EVENT_IDS)


class Follower:
    """Somebody who follows a job; `with` ends it."""

    def __init__(self, watch: Watch, job_id: str):
        self.job_id = job_id
        self.changed = asyncio.Event()
        self._watch = watch

    def __enter__(self) -> Follower:
        return self

    def __exit__(self, *_: object) -> None:
        self._watch.leave(self)

    async def wait(self) -> None:
        """Return when something may have happened since the last call."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self.changed.wait(), RECHECK_SECONDS)
        self.changed.clear()


async def _watch(request: Request) -> Watch:
    watch: Watch = request.app.state.watch
    return watch


InWatch = Annotated[Watch, Depends(_watch)]
