"""The database: its tables, its transactions."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import create_engine, text
from sqlalchemy.exc import IntegrityError

from service.database import Database
from service.drivers.models import Driver
from service.files.models import File
from service.ids import is_id, new_id
from service.tables import Base


@pytest.fixture
def database(tmp_path: Path) -> Database:
    opened = Database(f"sqlite:///{tmp_path / 'galatea.db'}")
    opened.upgrade()
    return opened


def file(created_at: datetime | None = None) -> File:
    moment = created_at or datetime.now(UTC)
    return File(id=new_id(), name="a", content_type="image/png", size=1, sha256="0" * 64, created_at=moment)


def test_the_migrations_make_the_tables_that_the_code_describes(database: Database) -> None:
    with create_engine(database.url).connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []


def test_many_may_bring_it_up_to_date_at_once(tmp_path: Path) -> None:
    databases = [Database(f"sqlite:///{tmp_path / 'new.db'}") for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(Database.upgrade, databases))
    with databases[0].read() as session:
        assert session.scalar(text("SELECT count(*) FROM jobs")) == 0


def test_a_block_that_fails_changes_nothing(database: Database) -> None:
    with pytest.raises(IntegrityError), database.write() as session:
        session.add(file())
        session.flush()
        session.add(Driver(name="x", file_id="nowhere", created_at=datetime.now(UTC)))
    with database.read() as session:
        assert session.scalar(text("SELECT count(*) FROM files")) == 0


def test_those_who_read_before_they_write_do_not_lose_each_others_changes(database: Database) -> None:
    with database.write() as session:
        session.add(first := file())

    def increment(_: int) -> None:
        with database.write() as session:
            session.get_one(File, first.id).size += 1

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(increment, range(40)))
    with database.read() as session:
        assert session.get_one(File, first.id).size == 41


def test_moments_keep_their_meaning(database: Database) -> None:
    moment = datetime(2026, 1, 2, 3, 4, 5, 678, tzinfo=timezone(timedelta(hours=9)))
    with database.write() as session:
        session.add(kept := file(moment))
    with database.read() as session:
        found = session.get_one(File, kept.id).created_at
    assert found == moment and found.utcoffset() == timedelta(0)


def test_ids_grow_with_time_and_differ() -> None:
    ids = [new_id() for _ in range(2000)]
    assert len(set(ids)) == 2000
    assert [one[:13] for one in ids] == sorted(one[:13] for one in ids)
    assert all(is_id(one) and one[14] == "7" and one[19] in "89ab" for one in ids)
    assert not any(map(is_id, ("", "happy", ids[0].upper(), ids[0][:-1], "{" + ids[0] + "}")))
