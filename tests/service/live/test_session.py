"""A live portrait's session: the newest is shown, and it ends by itself."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

from service.live.outlet import Outlet
from service.live.process import EVENT_TAG, LiveOrder
from service.live.session import LiveSession
from service.settings import Settings

ORDER = LiveOrder(Path("target"), {}, 1000)


class Echo:
    """A process that sends each frame back, and is ready at once."""

    def __init__(self) -> None:
        self._said: asyncio.Queue[tuple[bytes, bytes] | None] = asyncio.Queue()
        self._said.put_nowait((EVENT_TAG, b'{"event": "ready"}'))

    def send(self, kind: bytes, data: bytes) -> bool:
        self._said.put_nowait((kind, data))
        return True

    async def receive(self) -> tuple[bytes, bytes] | None:
        return await self._said.get()

    def kill(self) -> None:
        self._said.put_nowait(None)


async def start(order: LiveOrder) -> Echo:
    return Echo()


def session(**settings: Any) -> LiveSession:
    return LiveSession("1", "me", "secret", Settings(**{"live_idle_seconds": 0.6, **settings}))


def run(work: Coroutine[Any, Any, None]) -> None:
    asyncio.run(asyncio.wait_for(work, 20))


async def taken(outlet: Outlet, frames: int) -> list[bytes]:
    found: list[bytes] = []
    while len(found) < frames:
        message = await outlet.take()
        if isinstance(message, bytes):
            found.append(message)
    return found


def test_who_looks_gets_events_first_and_then_the_newest_frame_alone() -> None:
    async def work() -> None:
        outlet = Outlet()
        for number in range(5):
            outlet.show(bytes([number]))
        outlet.tell({"event": "ready"})
        assert [await outlet.take(), await outlet.take()] == [{"event": "ready"}, b"\x04"]

    run(work())


def test_frames_go_through_the_process_to_all_who_look() -> None:
    async def work() -> None:
        one = session()
        running = asyncio.ensure_future(one.run(start, ORDER))
        outlets = [one.look(), one.look()]
        one.has_camera = True
        await asyncio.sleep(0.05)
        one.feed(b"\0\0\0\1picture")
        assert [await taken(outlet, 1) for outlet in outlets] == [[b"\0\0\0\1picture"]] * 2
        assert one.status == "live"
        one.end("live_ended")
        await running

    run(work())


def ended(one: LiveSession, feed: bytes | None, look: bool, stop_after: float = 10.0) -> str:
    """The code by which a session ends whose camera sends `feed` again and again, and who looks or not."""

    async def work() -> None:
        running = asyncio.ensure_future(one.run(start, ORDER))
        outlet = one.look()
        one.has_camera = True
        for _ in range(int(stop_after / 0.05)):
            await asyncio.sleep(0.05)
            if one.ended is not None:
                break
            if feed is not None:
                one.feed(feed)
            if look and feed is not None:
                await taken(outlet, 1)
        await running

    run(work())
    assert one.ended is not None
    return str(one.ended["code"])


def test_it_ends_when_no_frame_comes() -> None:
    assert ended(session(), None, True) == "live_idle"


def test_it_ends_when_nobody_takes_its_frames() -> None:
    assert ended(session(), b"\0\0\0\1picture", False) == "live_idle"


def test_it_ends_after_the_longest_time_although_somebody_looks() -> None:
    assert ended(session(live_seconds=1.0), b"\0\0\0\1picture", True) == "live_time_limit"


def test_a_frame_that_is_too_large_ends_it() -> None:
    assert ended(session(live_frame_mb=0.001), bytes(1001), False) == "live_frame_too_large"


def test_a_frame_without_a_picture_ends_it() -> None:
    assert ended(session(), b"\0\0", False) == "live_frame_unreadable"


def test_a_process_that_cannot_start_ends_it() -> None:
    async def work() -> None:
        async def broken(order: LiveOrder) -> Echo:
            raise OSError("no processes left")

        one = session()
        await one.run(broken, ORDER)
        assert one.ended is not None and one.ended["code"] == "live_failed"

    run(work())
