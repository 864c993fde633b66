"""Who follows a job is woken by its events, whoever writes them and in whatever order they become visible."""

from __future__ import annotations

import asyncio

import pytest

from service.clock import now
from service.connections.stopping import Stopping
from service.context import Context
from service.events.watch import Watch
from service.ids import new_id
from service.tables.events import Event
from service.tables.jobs import Job

GIVEN_UP_SECONDS = 30


@pytest.fixture
def two_jobs(context: Context) -> list[str]:
    ids = [new_id(), new_id()]
    job = {"kind": "tiny", "status": "running", "inputs": {}, "sources": {}, "options": {}, "notes": {}}
    with context.database.write() as session:
        for one in ids:
            session.add(Job(id=one, owner="local", progress={}, created_at=now(), enqueued_at=now(), **job))
    return ids


def write(context: Context, job_id: str, number: int) -> None:
    with context.database.write() as session:
        session.add(Event(id=number, job_id=job_id, type="progress", data={}, created_at=now()))


async def woken(changed: asyncio.Event) -> None:
    await asyncio.wait_for(changed.wait(), GIVEN_UP_SECONDS)
    changed.clear()


def test_an_event_that_shows_after_a_newer_one_wakes_its_followers_too(context: Context, two_jobs: list[str]) -> None:
    """As where a transaction that drew its id first ends last."""
    first, second = two_jobs

    async def follow() -> None:
        watch = Watch(context, Stopping())
        with watch.follow(first) as one, watch.follow(second) as other:
            write(context, first, 1000)
            await woken(one.changed)
            write(context, second, 990)
            await woken(other.changed)
            assert not one.changed.is_set(), "nothing has happened to that one"
            write(context, first, 1001)
            await woken(one.changed)
            assert not other.changed.is_set()

    asyncio.run(follow())


def test_the_end_of_the_service_wakes_all(context: Context, two_jobs: list[str]) -> None:
    async def follow() -> None:
        stopping = Stopping()
        watch = Watch(context, stopping)
        with watch.follow(two_jobs[0]) as one, watch.follow(two_jobs[1]) as other:
            stopping.begin()
            assert one.changed.is_set() and other.changed.is_set()

    asyncio.run(follow())
