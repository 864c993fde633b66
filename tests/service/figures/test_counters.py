"""Figures that only grow."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from service.database.sessions import Database
from service.figures import counters


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    opened = Database(database_url)
    yield opened
    opened.close()


def test_many_count_at_once(database: Database) -> None:
    def count(_: int) -> None:
        with database.write() as session:
            counters.add(session, "galatea_uploaded_bytes", "image", amount=5)

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(count, range(40)))
    with database.read() as session:
        assert list(counters.all_counters(session)) == [("galatea_uploaded_bytes", ["image"], 200.0)]


def test_what_fails_is_not_counted(database: Database) -> None:
    with pytest.raises(ZeroDivisionError), database.write() as session:
        counters.add(session, "galatea_uploaded_bytes", "image")
        _ = 1 / 0
    with database.read() as session:
        assert list(counters.all_counters(session)) == []


def test_labels_of_any_text_fit(database: Database) -> None:
    with database.write() as session:
        counters.add(session, "galatea_stage_runs", "tiny", "x" * 500)
        counters.add(session, "galatea_stage_runs", "tiny", 'a "b", \\c')
    with database.read() as session:
        assert {labels[1] for _, labels, _ in counters.all_counters(session)} == {"x" * 50, 'a "b", \\c'}
