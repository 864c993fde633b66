"""The tables and what their columns hold: moments and secrets come back as they were, on both databases."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta, timezone

import pytest
from sqlalchemy import select

from service import tables
from service.database.sessions import Database
from service.ids import new_id
from service.tables.base import moment_in
from service.tables.files import File
from service.tables.jobs import Status


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    opened = Database(database_url)
    yield opened
    opened.close()


def file(created_at: datetime) -> File:
    return File(
        **{"id": new_id(), "owner": "local", "name": "a", "content_type": "image/png", "size": 1},
        **{"sha256": "0" * 64, "created_at": created_at},
    )


def test_the_database_knows_all_tables_whoever_opens_it() -> None:
    program = "from service.database.sessions import Base; print(*Base.metadata.tables)"
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert {"artifacts", "drivers", "jobs", "keys", "webhooks"} <= set(told.split())
    assert len(told.split()) == len(set(tables.__all__) - {"Base"})


def test_moments_keep_their_meaning(database: Database) -> None:
    moment = datetime(2026, 1, 2, 3, 4, 5, 678, tzinfo=timezone(timedelta(hours=9)))
    with database.write() as session:
        session.add(kept := file(moment))
    with database.read() as session:
        found = session.get_one(File, kept.id).created_at
    assert found == moment and found.utcoffset() == timedelta(0)


def test_its_own_clock_is_what_leases_are_measured_by(database: Database) -> None:
    with database.write() as session:
        session.add(kept := file(datetime.now(UTC)))
        session.flush()
        kept.created_at = moment_in(-60)  # type: ignore[assignment]
    with database.read() as session:
        found = session.get_one(File, kept.id).created_at
        assert abs(found - (datetime.now(UTC) - timedelta(seconds=60))) < timedelta(seconds=30)
        later = select(File.id).where(File.created_at < moment_in(-59.5))
        assert session.scalar(later) == kept.id
        assert session.scalar(select(File.id).where(File.created_at < moment_in(-90))) is None


def test_a_job_is_over_in_all_states_but_two() -> None:
    assert [status for status in Status if not status.final] == [Status.QUEUED, Status.RUNNING]
