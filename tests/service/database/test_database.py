"""The database: its transactions."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime

import pytest
from servers import PostgresServer
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError, IntegrityError

from service.database.sessions import Database, database_unavailable
from service.ids import is_id, new_id
from service.tables.files import File
from service.tables.kept import Driver


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    opened = Database(database_url)
    yield opened
    opened.close()


def file(created_at: datetime | None = None) -> File:
    moment = created_at or datetime.now(UTC)
    return File(
        id=new_id(), owner="local", name="a", content_type="image/png", size=1, sha256="0" * 64, created_at=moment
    )


def test_many_may_bring_it_up_to_date_at_once(bare_database_url: str) -> None:
    databases = [Database(bare_database_url) for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(Database.upgrade, databases))
    with databases[0].read() as session:
        assert session.scalar(text("SELECT count(*) FROM jobs")) == 0
    for one in databases:
        one.close()


def test_a_block_that_fails_changes_nothing(database: Database) -> None:
    with pytest.raises(IntegrityError), database.write() as session:
        session.add(file())
        session.flush()
        session.add(Driver(owner="local", name="x", file_id="nowhere", created_at=datetime.now(UTC)))
    with database.read() as session:
        assert session.scalar(text("SELECT count(*) FROM files")) == 0


def test_those_who_read_before_they_write_do_not_lose_each_others_changes(database: Database) -> None:
    with database.write() as session:
        session.add(first := file())

    def increment(_: int) -> None:
        with database.write() as session:
            session.get_one(File, first.id, with_for_update=True).size += 1

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(increment, range(40)))
    with database.read() as session:
        assert session.get_one(File, first.id).size == 41


def test_who_reads_sees_one_moment(database: Database) -> None:
    count = text("SELECT count(*) FROM files")
    with database.read() as session:
        before = session.scalar(count)
        with database.write() as other:
            other.add(file())
        assert session.scalar(count) == before == 0


def test_tidying_up_keeps_nobody_from_writing_while_others_read(database: Database) -> None:
    with database.write() as session:
        session.add(file())
    with ThreadPoolExecutor(2) as pool, database.read() as reading:
        assert reading.scalar(text("SELECT count(*) FROM files")) == 1  # it reads until the block ends
        with database.write() as session:
            session.add(file())  # so that there is something new in the log
        tidying = pool.submit(database.tidy)

        def write() -> None:
            with database.write() as session:
                session.add(file())

        pool.submit(write).result(10)
        tidying.result(60)
        assert reading.scalar(text("SELECT count(*) FROM files")) == 1
    database.tidy()
    with database.read() as session:
        assert session.scalar(text("SELECT count(*) FROM files")) == 3


def test_who_reads_cannot_write_on_postgresql(database: Database) -> None:
    if database.url.startswith("sqlite"):
        pytest.skip("SQLite knows no transaction that only reads")
    with pytest.raises(DBAPIError, match="read-only"), database.read() as session:
        session.add(file())
        session.flush()


def test_a_connection_that_is_reset_is_a_database_that_is_away(postgres: PostgresServer) -> None:
    """The server's process behind an idle connection is killed with a question unread, so that the system answers by a reset."""
    database = Database(postgres.new_database())
    with database.read() as session:
        process = session.scalar(text("SELECT pg_backend_pid()"))
    os.kill(process, signal.SIGSTOP)
    killing = threading.Timer(0.5, os.kill, (process, signal.SIGKILL))
    killing.start()
    try:
        with database.read() as session:
            session.scalar(text("SELECT 1"))
    except DBAPIError as error:
        assert database_unavailable(error)
    killing.join()
    postgres.stop()
    postgres.start()
    with database.read() as session:
        assert session.scalar(text("SELECT 1")) == 1
    database.close()


def test_ids_grow_with_time_and_differ() -> None:
    ids = [new_id() for _ in range(2000)]
    assert len(set(ids)) == 2000
    assert [one[:13] for one in ids] == sorted(one[:13] for one in ids)
    assert all(is_id(one) and one[14] == "7" and one[19] in "89ab" for one in ids)
    assert not any(map(is_id, ("", "happy", ids[0].upper(), ids[0][:-1], "{" + ids[0] + "}")))
