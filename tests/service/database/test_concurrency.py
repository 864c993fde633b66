"""What many writers at once must not break; on PostgreSQL they really are at it at once."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta

import pytest

from service.clock import now
from service.database.sessions import Database
from service.events import repository as events
from service.files import repository as files
from service.ids import new_id
from service.tables.events import Event
from service.tables.files import File
from service.tables.jobs import Job, JobFile


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    opened = Database(database_url)
    yield opened
    opened.close()


@pytest.fixture
def job(database: Database) -> Job:
    made = Job(
        id=new_id(),
        owner="local",
        **{"kind": "tiny", "status": "running", "inputs": {}, "sources": {}, "options": {}, "notes": {}},
        **{"progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with database.write() as session:
        session.add(made)
    return made


def test_a_follower_misses_no_event_however_many_write(database: Database, job: Job) -> None:
    """The ids of a job's events become visible in their order: nothing appears behind one that was seen."""
    writers = 6
    over = threading.Event()
    seen: list[int] = []

    def follow() -> None:
        last = False
        while not last:
            last = over.is_set()
            with database.read() as session:
                seen.extend(event.id for event in events.events_after(session, job.id, seen[-1] if seen else 0))

    def write(number: int) -> None:
        for step in range(15):
            with database.write() as session:
                events.append(session, job.id, "progress", {"writer": number, "step": step})
                session.flush()
                over.wait(0.002 * number)  # the id is drawn, the transaction not yet over

    follower = threading.Thread(target=follow)
    follower.start()
    with ThreadPoolExecutor(writers) as pool:
        list(pool.map(write, range(writers)))
    over.set()
    follower.join()
    with database.read() as session:
        assert seen == [event.id for event in events.events_after(session, job.id, 0)]
    assert len(seen) == writers * 15


def test_without_the_job_s_row_as_a_lock_events_would_come_out_of_order(database: Database, job: Job) -> None:
    """Why `events.append` locks: the race itself, on the database that has it."""
    if database.url.startswith("sqlite"):
        pytest.skip("SQLite lets one write at a time")

    def event(name: str) -> Event:
        return Event(job_id=job.id, type="progress", data={"name": name}, created_at=now())

    with database.write() as slow:
        slow.add(event("first"))
        slow.flush()
        with database.write() as quick:
            quick.add(event("second"))
        with database.read() as session:
            assert [one.data["name"] for one in events.events_after(session, job.id, 0)] == ["second"]


def test_a_file_that_a_job_takes_in_this_moment_is_not_erased(database: Database, job: Job) -> None:
    if database.url.startswith("sqlite"):
        pytest.skip("SQLite lets one write at a time")
    yesterday = datetime.now(UTC) - timedelta(days=1)
    file = File(
        id=new_id(), owner="local", name="a", content_type="image/png", size=1, sha256="0" * 64, created_at=yesterday
    )
    with database.write() as session:
        session.add(file)
    with database.write() as submitting:
        assert files.get_locked(submitting, "local", file.id) is not None
        with database.write() as erasing:
            assert files.erase_unused(erasing, before=now()) == [], "it is held"
        submitting.add(JobFile(job_id=job.id, file_id=file.id))
    with database.write() as erasing:
        assert files.erase_unused(erasing, [file.id]) == [], "it is used"


def test_of_a_job_and_an_eraser_that_want_a_file_one_gives_way(database: Database, job: Job) -> None:
    """Whoever comes second finds out, and nothing breaks."""
    outcomes = set()
    for _ in range(20):
        file = File(
            id=new_id(), owner="local", name="a", content_type="image/png", size=1, sha256="0" * 64, created_at=now()
        )
        with database.write() as session:
            session.add(file)
        barrier = threading.Barrier(2)

        def take(file: File = file, barrier: threading.Barrier = barrier) -> bool:
            barrier.wait()
            with database.write() as session:
                if files.get_locked(session, "local", file.id) is None:
                    return False
                session.add(JobFile(job_id=job.id, file_id=file.id))
                return True

        def erase(file: File = file, barrier: threading.Barrier = barrier) -> bool:
            barrier.wait()
            with database.write() as session:
                return len(files.erase_unused(session, [file.id])) == 1

        with ThreadPoolExecutor(2) as pool:
            taken, erased = pool.submit(take), pool.submit(erase)
            outcomes.add((taken.result(), erased.result()))
    assert outcomes <= {(True, False), (False, True)}
