"""A live portrait is its owner's, and others look at it by its token alone."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest

from service.connections.stopping import Stopping
from service.context import Context
from service.live.process import LiveOrder, LiveProcess
from service.live.session import LiveSession
from service.live.sessions import LiveSessions
from service.problems import Problem


async def never(order: LiveOrder) -> LiveProcess:
    raise OSError("no process is wanted here")


def begun(context: Context, then: Callable[[LiveSessions, LiveSession], None]) -> None:
    """Do something with a live portrait that was begun by "me"."""

    async def work() -> None:
        sessions = LiveSessions(context, Stopping(), never)
        session = sessions.begin("me", "of no file", LiveOrder(Path("target"), {}, 1000))
        then(sessions, session)
        session.end("live_ended")

    asyncio.run(work())


def test_its_owner_finds_it_and_nobody_else(context: Context) -> None:
    def look(sessions: LiveSessions, session: LiveSession) -> None:
        assert sessions.find(session.id, "me") is session
        assert (sessions.under_way("me"), sessions.under_way("another"), sessions.under_way()) == (1, 0, 1)
        for id, owner in ((session.id, "another"), ("of none", "me")):
            with pytest.raises(Problem) as refused:
                sessions.find(id, owner)
            assert (refused.value.status, refused.value.code) == (404, "live_not_found")

    begun(context, look)


def test_its_token_opens_it_and_no_other(context: Context) -> None:
    def look(sessions: LiveSessions, session: LiveSession) -> None:
        assert sessions.find_to_view(session.id, session.view_token) is session
        for id, token in ((session.id, session.view_token[:-1]), (session.id, ""), ("of none", session.view_token)):
            with pytest.raises(Problem) as refused:
                sessions.find_to_view(id, token)
            assert (refused.value.status, refused.value.code) == (404, "live_not_found")

    begun(context, look)
