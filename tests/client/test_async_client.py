"""The client for asyncio against a service that runs, and beside the one that blocks."""

from __future__ import annotations

import asyncio
import hashlib
import inspect
import threading
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, BinaryIO, cast

import pytest
from broken_line import AsyncBrokenLine
from pydantic import BaseModel
from running import Running

from galatea_client import (
    ArtifactEvent,
    AsyncClient,
    AsyncJob,
    Client,
    Conflict,
    InvalidRequest,
    Job,
    JobFailed,
    NotFound,
    ProgressEvent,
    Status,
    StatusEvent,
    Unreachable,
)

WHOLE = bytes(range(256)) * 400
"""What the tiny kind leaves as animation.mp4."""


def using(
    running: Running, story: Callable[[AsyncClient], Coroutine[Any, Any, None]], line: AsyncBrokenLine | None = None
) -> None:
    """Tell a story to a client of the service."""

    async def told() -> None:
        async with AsyncClient(str(running.client.base_url), transport=line) as galatea:
            await story(galatea)

    asyncio.run(told())


def public(kind: type) -> dict[str, list[inspect.Parameter]]:
    return {
        name: list(inspect.signature(one).parameters.values())
        for name, one in inspect.getmembers(kind, inspect.isfunction)
        if not name.startswith("_") and not hasattr(BaseModel, name) and name != "bound"
    }


@pytest.mark.parametrize(("blocking", "for_asyncio"), [(Client, AsyncClient), (Job, AsyncJob)])
def test_both_have_the_same_methods_with_the_same_parameters(blocking: type, for_asyncio: type) -> None:
    assert public(blocking) == public(for_asyncio)
    assert {"wait", "follow", "download", "cancel"} <= set(public(blocking))
    assert all(inspect.getdoc(getattr(kind, name)) for kind in (blocking, for_asyncio) for name in public(kind))
    for name in public(blocking):
        assert not inspect.iscoroutinefunction(getattr(blocking, name)), name
        one = getattr(for_asyncio, name)
        iterates = inspect.signature(one).return_annotation.startswith("AsyncGenerator")
        assert iterates or inspect.iscoroutinefunction(one), name


def test_from_a_picture_to_its_results(running: Running, picture: Path, tmp_path: Path) -> None:
    async def story(galatea: AsyncClient) -> None:
        seen: list[tuple[int, int]] = []
        file = await galatea.upload(picture, lambda done, whole: seen.append((done, whole)))
        assert seen[-1] == (picture.stat().st_size,) * 2
        assert file.sha256 == hashlib.sha256(picture.read_bytes()).hexdigest() and await galatea.file(file.id) == file
        job = await galatea.submit("tiny", {"image": file.id}, {"seconds": 0.2}, metadata={"order": 7})
        progress: list[float] = []
        done = await job.wait(progress=lambda told: progress.append(told.fraction))
        assert done.status is Status.SUCCEEDED and done.metadata == {"order": 7} and progress
        got = await done.download("animation.mp4", tmp_path / "out")
        assert got == tmp_path / "out" / "animation.mp4" and got.read_bytes() == WHOLE
        assert {path.name for path in await done.download_all(tmp_path / "all")} == set(done.artifacts)
        assert (await galatea.download_archive(job.id, tmp_path)).stat().st_size > 0
        assert job.id in [one.id async for one in galatea.jobs(status=["succeeded"])]
        revised = await (await job.revise({"mask": picture})).wait()
        assert [one.id for one in await revised.revisions()] == [job.id, revised.id]
        await revised.delete()
        with pytest.raises(NotFound):
            await revised.refresh()

    using(running, story)


def test_events_come_as_they_do_to_the_other_client(running: Running, galatea: Client, picture: Path) -> None:
    async def story(asynchronous: AsyncClient) -> None:
        job = await asynchronous.submit("tiny", {"image": picture}, {"seconds": 0.5})
        events = [event async for event in job.follow()]
        assert {type(event) for event in events} == {StatusEvent, ProgressEvent, ArtifactEvent}
        assert events == list(galatea.follow(job.id)), "the other client also works inside of an event loop"
        assert [event async for event in job.follow(after=events[-3].id)] == events[-2:]

    using(running, story)


def test_broken_lines_are_taken_up(running: Running, picture: Path, tmp_path: Path) -> None:
    events, download = AsyncBrokenLine("/events", 500, 3), AsyncBrokenLine("/artifacts/animation.mp4", 70_000, 1)

    async def follows(galatea: AsyncClient) -> None:
        job = await galatea.submit("tiny", {"image": picture}, {"seconds": 1.5})
        assert [event async for event in job.follow()] == [event async for event in job.follow()]

    async def downloads(galatea: AsyncClient) -> None:
        job = await (await galatea.submit("tiny", {"image": picture})).wait()
        assert (await job.download("animation.mp4", tmp_path)).read_bytes() == WHOLE

    using(running, follows, events)
    asked = [int(one.headers.get("Last-Event-ID", 0)) for one in events.requests if "/events" in one.url.path]
    assert len(asked) >= 4 and asked[:-1] == sorted(set(asked[:-1])) and asked[-1] == 0
    using(running, downloads, download)
    assert [path.name for path in tmp_path.glob("*.part")] == []
    assert len([one for one in download.requests if "/artifacts/" in one.url.path]) == 2


def test_errors_are_the_same(running: Running, picture: Path) -> None:
    async def story(galatea: AsyncClient) -> None:
        with pytest.raises(InvalidRequest) as error:
            await galatea.submit("tiny", {"image": picture}, {"seconds": -1})
        assert error.value.errors[0]["pointer"] == "/options/seconds"
        with pytest.raises(JobFailed, match="No face") as failed:
            await (await galatea.submit("tiny", {"image": picture}, {"crash": "refuse"})).wait()
        assert isinstance(failed.value.job, AsyncJob)
        long = await galatea.submit("tiny", {"image": picture}, {"seconds": 60})
        waiting = asyncio.create_task(long.wait())
        assert (await long.cancel()).status is Status.CANCELED
        with pytest.raises(JobFailed, match="canceled"):
            await waiting
        ended = await (await galatea.submit("tiny", {"image": picture})).wait()
        with pytest.raises(Conflict):
            await ended.cancel()
        async with AsyncClient("http://127.0.0.1:9", retries=0) as nobody:
            with pytest.raises(Unreachable):
                await nobody.kinds()

    using(running, story)


def test_many_are_waited_for_at_once_and_a_wait_can_be_given_up(running: Running, picture: Path) -> None:
    async def story(galatea: AsyncClient) -> None:
        long = await galatea.submit("tiny", {"image": picture}, {"seconds": 300})
        waiting = asyncio.create_task(long.wait())
        assert {kind.name for kind in (await asyncio.gather(*(galatea.kinds() for _ in range(5))))[-1]} == {"tiny"}
        assert not waiting.done()
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        await long.cancel()

    using(running, story)


class Watched:
    """An open file that notes the threads that read it."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.readers: set[int] = set()

    def read(self, size: int = -1) -> bytes:
        self.readers.add(threading.get_ident())
        return self._file.read(size)

    def seek(self, offset: int, whence: int = 0) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()


def test_files_are_read_beside_the_event_loop(running: Running, picture: Path) -> None:
    async def story(galatea: AsyncClient) -> None:
        with picture.open("rb") as opened:
            watched = Watched(opened)
            await galatea.upload(cast(BinaryIO, watched))
        assert watched.readers and threading.get_ident() not in watched.readers

    using(running, story)


def test_links_are_whole_addresses(running: Running, galatea: Client, picture: Path) -> None:
    base = str(running.client.base_url).rstrip("/")
    job = galatea.submit("tiny", {"image": picture}).wait()
    link = job.link()
    events = [event for event in job.follow() if isinstance(event, ArtifactEvent)]
    results = [*job.artifacts.values(), *(event.artifact for event in events)]
    told = [link.url, link.page, *(one.url for one in results)]
    told += [one.signed_url for one in job.artifacts.values()]
    told += [address for driver in galatea.drivers() for address in (driver.url, driver.poster) if address]
    assert all(address and address.startswith(base + "/") for address in told), told
    assert running.client.get(job.artifacts["animation.mp4"].url).content == WHOLE
