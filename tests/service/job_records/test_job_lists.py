"""Lists of jobs: whose they are, in what order, and of each work the newest that is asked for."""

from __future__ import annotations

from datetime import timedelta

import pytest
from sqlalchemy.orm import Session

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.job_records import jobs
from service.keys.schemas import KeyIn
from service.keys.service import create
from service.tables.files import File
from service.tables.jobs import Job, Status
from service.tables.kept import Driver, Motion


@pytest.fixture
def other(context: Context) -> str:
    """Another owner."""
    with context.database.write() as session:
        key, _ = create(session, KeyIn(name="other"))
        return key.id


def add(session: Session, status: str, tree: str | None = None, owner: str = "local", search: str = "") -> str:
    job = Job(
        id=(own := new_id()),
        **{"owner": owner, "kind": "tiny", "status": status, "tree": tree or own, "inputs": {}, "sources": {}},
        **{"options": {}, "notes": {}, "progress": {}, "created_at": now(), "enqueued_at": now(), "search": search},
    )
    session.add(job)
    session.flush()
    return job.id


def test_of_each_work_the_newest_is_listed_that_is_let_through(context: Context, other: str) -> None:
    with context.database.write() as session:
        first = add(session, "succeeded", search="rome")
        second = add(session, "succeeded", first, search="paris")
        third = add(session, "failed", first, search="oslo")
        alone = add(session, "succeeded", search="rome")
        add(session, "succeeded", owner=other, search="rome")
    with context.database.read() as session:

        def listed(**wanted: object) -> list[str]:
            return [job.id for job in jobs.page(session, "local", 10, latest=True, **wanted)]  # type: ignore[arg-type]

        assert listed() == [alone, third]
        assert listed(statuses=[Status.SUCCEEDED]) == [alone, second]
        assert listed(words=["rome"]) == [alone, first]
        assert listed(before_id=alone) == [third]


def test_a_list_is_newest_first_and_has_nobody_else_s(context: Context, other: str) -> None:
    with context.database.write() as session:
        ids = [add(session, "succeeded") for _ in range(3)]
        theirs = add(session, "running", owner=other)
    with context.database.read() as session:
        assert [job.id for job in jobs.page(session, "local", 10)] == ids[::-1]
        assert [job.id for job in jobs.page(session, "local", 1, before_id=ids[2])] == [ids[1]]
        assert [job.id for job in jobs.page(session, other, 10)] == [theirs]
        assert jobs.page(session, other, 10, statuses=[Status.SUCCEEDED]) == []
        assert jobs.running(session, [*ids, theirs]) == {theirs}


def test_versions_are_those_of_one_owner(context: Context, other: str) -> None:
    with context.database.write() as session:
        first = add(session, "succeeded")
        add(session, "failed", first)
        theirs = add(session, "succeeded", owner=other)
    with context.database.read() as session:
        assert jobs.versions(session, "local", [first, theirs]) == {first: 2}


def test_what_was_found_in_something_that_is_kept_does_not_end_with_other_old_jobs(context: Context) -> None:
    with context.database.write() as session:
        old, of_driver, of_motion, young = (add(session, "succeeded") for _ in range(4))
        for one, days in ((old, 30), (of_driver, 40), (of_motion, 40), (young, 1)):
            session.get_one(Job, one).finished_at = now() - timedelta(days=days)
        file = File(id=new_id(), owner="local", name="a", content_type="video/mp4", size=1, sha256="", created_at=now())
        session.add(file)
        session.flush()
        for table, inspection in ((Driver, of_driver), (Motion, of_motion), (Driver, None)):
            name = f"{table.__name__} {inspection is None}"
            session.add(table(owner="local", name=name, file_id=file.id, inspection_job=inspection, created_at=now()))
    with context.database.read() as session:
        assert [job.id for job in jobs.ended_before(session, now() - timedelta(days=20), 10)] == [old]
