"""Migrations, up and down, on both databases, with data in them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import datetime
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import MetaData, Table, create_engine, insert, select, text

from service.auth.tokens import digest
from service.database.sessions import Database, DatabaseInUse, DowngradeLosesData, newest_version, postgresql
from service.database.steps import alembic_config
from service.links.repository import page, valid_link
from service.tables import Base

SCRIPTS = ScriptDirectory.from_config(alembic_config())
REVISIONS = [script.revision for script in SCRIPTS.walk_revisions()][::-1]

MOMENT = "2026-01-02 03:04:05.678000+00:00"
OLD: dict[str, dict[str, Any]] = {
    "files": {"id": "f" * 36, "name": "\u00e4.png", "content_type": "image/png", "size": 5 * 2**40, "sha256": "0" * 64},
    "jobs": {
        **{"id": "j" * 36, "kind": "portrait", "status": "succeeded", "lease_token": 3, "attempts": 2},
        **{"fruitless_attempts": 0, "inputs": {"image": "f" * 36}, "sources": {}, "options": {"strength": 0.8}},
        **{"metadata": {"order": "\u00fc"}, "progress": {}, "error": None},
    },
    "artifacts": {
        **{"id": "a" * 36, "job_id": "j" * 36, "name": "report.json", "content_type": "application/json"},
        **{"size": 2, "sha256": "1" * 64},
    },
    "drivers": {"name": "mine", "file_id": "f" * 36},
    "events": {"id": 7, "job_id": "j" * 36, "type": "status", "data": {"status": "succeeded"}},
    "idempotency_keys": {"key": "order-1", "fingerprint": "2" * 64, "job_id": "j" * 36},
    "job_files": {"job_id": "j" * 36, "file_id": "f" * 36},
}
"""A row of each table of the first version."""


@pytest.fixture
def database(bare_database_url: str) -> Iterator[Database]:
    opened = Database(bare_database_url)
    yield opened
    opened.close()


def connect(database: Database) -> Any:
    url = database.url
    place, arguments = postgresql.address(url) if postgresql.is_postgresql_url(url) else (url, {})
    return create_engine(place, connect_args=arguments).begin()


def rows(database: Database) -> dict[str, Any]:
    """What the rows of the first version hold now, by table, in the columns that they had."""
    with connect(database) as connection:
        return {
            name: [
                [_plain(value) for value in found]
                for found in connection.execute(text(f"SELECT {', '.join(row)} FROM {name}"))
            ]
            for name, row in OLD.items()
        }


def _plain(value: object) -> object:
    """SQLite gives JSON as text, PostgreSQL what it says."""
    return json.loads(value) if isinstance(value, str) and value.startswith("{") else value


def fill(database: Database) -> None:
    with connect(database) as connection:
        for name, row in OLD.items():
            table = Table(name, MetaData(), autoload_with=connection)
            moments = [c.name for c in table.c if c.name.endswith("_at") and not c.nullable]
            given = row | {column: datetime.fromisoformat(MOMENT) for column in moments}
            connection.execute(insert(table).values(given))


def test_each_step_up_and_down_keeps_what_was_there(database: Database) -> None:
    database.migrate(REVISIONS[0])
    fill(database)
    before = rows(database)
    for revision in REVISIONS[1:]:
        database.migrate(revision)
        assert rows(database) == before, f"up to {revision}"
    assert database.revision() == REVISIONS[-1]
    for revision in REVISIONS[-2::-1]:
        database.migrate(revision, forget=True)
        assert database.revision() == revision
        assert rows(database) == before, f"down to {revision}"
    database.upgrade()
    assert rows(database) == before
    with database.read() as session:
        (job,) = session.scalars(select(Base.metadata.tables["jobs"].c.id)).all()
        assert job == "j" * 36
    database.migrate("base", forget=True)
    with connect(database) as connection:
        metadata = MetaData()
        metadata.reflect(connection)
    assert set(metadata.tables) == {"alembic_version"}


def test_the_newest_version_is_the_head() -> None:
    """It is told by the files' names, without alembic, wherever the tables are up to date already."""
    assert newest_version() == SCRIPTS.get_current_head()


def test_tables_that_somebody_uses_are_left_as_they_are(database: Database) -> None:
    user = Database(database.url)
    user.upgrade()
    with user.read() as session:
        session.execute(text("SELECT 1"))
    with pytest.raises(DatabaseInUse):
        database.migrate("0005", forget=True)
    assert database.revision() == REVISIONS[-1]
    user.close()
    database.migrate("0005", forget=True)
    assert database.revision() == "0005"
    database.upgrade()
    with user.read() as session:
        session.execute(text("SELECT 1"))
    user.close()


def test_what_would_be_lost_is_said_before(database: Database) -> None:
    database.upgrade()
    with pytest.raises(DowngradeLosesData, match="the table motions"):
        database.migrate("0010")
    assert database.revision() == REVISIONS[-1]
    lost = database.forgets("0005")
    assert {"the table webhooks", "the table uploads", "the table webhook_deliveries"} <= set(lost)
    (jobs,) = [one for one in lost if one.startswith("of jobs")]
    assert {"priority", "request", "trace", "title"} <= set(jobs.removeprefix("of jobs ").split(", "))
    assert database.forgets("head") == database.forgets(REVISIONS[-1]) == []
    assert "the table jobs" in database.forgets("base")
    database.migrate("0005", forget=True)
    assert database.forgets("head") == [] and database.forgets("0005") == []
    database.migrate("head")


def test_links_of_before_go_on_working(database: Database) -> None:
    """Only hashes of their tokens are left; those of revoked keys are gone."""
    database.migrate(REVISIONS[0])
    fill(database)
    database.migrate("0013")
    with connect(database) as connection:
        keys = Table("keys", MetaData(), autoload_with=connection)
        local = connection.execute(select(keys)).mappings().one()
        moment = datetime.fromisoformat(MOMENT)
        connection.execute(insert(keys).values({**local, "id": "k" * 36, "revoked_at": moment}))
        links = Table("public_links", MetaData(), autoload_with=connection)
        for number, owner in enumerate(("local", "k" * 36)):
            row = {"id": f"{number}" * 36, "token": f"token-{number}", "owner": owner, "job_id": "j" * 36}
            connection.execute(insert(links).values(row | {"created_at": moment}))
    database.upgrade()
    with database.read() as session:
        link = valid_link(session, "token-0")
        assert link is not None and (link.id, link.hint) == ("0" * 36, "token-")
        assert link.token_hash == digest("token-0")
        assert valid_link(session, "token-1") is None and valid_link(session, link.token_hash) is None
    with database.read() as session:
        assert [one.id for one in page(session, None, 10, None)] == ["0" * 36]


def test_jobs_of_before_are_found_by_words(database: Database) -> None:
    database.migrate(REVISIONS[0])
    fill(database)
    database.migrate("0012")
    with connect(database) as connection:
        assert connection.execute(text("SELECT title, search FROM jobs")).all() == [(None, "\nportrait\n\u00e4.png")]


def test_the_migrations_make_the_tables_that_the_code_describes(database: Database) -> None:
    database.upgrade()
    with connect(database) as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []
