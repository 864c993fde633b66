"""By what words jobs are found, on both databases alike."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from engine.kind import Input, Kind
from service.clock import now
from service.database.sessions import Database
from service.ids import new_id
from service.job_records import jobs as repository
from service.job_records import search
from service.keys.schemas import KeyIn
from service.keys.service import create
from service.tables.files import File
from service.tables.jobs import Job
from service.tables.keys import LOCAL_KEY_ID


def test_case_and_ways_of_writing_a_letter_make_no_difference() -> None:
    assert search.search_words("  STRASSE e\u0301t\u00c9 \ufb01n ") == ["strasse", "\u00e9t\u00e9", "fin"]


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    opened = Database(database_url)
    yield opened
    opened.close()


def test_both_databases_find_the_same(database: Database) -> None:
    kind = Kind("painting", "", [Input("motion", "motion", "", named_by="motion", library="motions")], None, None)  # type: ignore[arg-type]
    moment = now()
    with database.write() as session:
        file = File(
            id=new_id(),
            owner=LOCAL_KEY_ID,
            name="ÉTÉ\u2028x.png",
            content_type="image/png",
            size=1,
            sha256="",
            created_at=moment,
        )
        session.add(file)
        session.flush()
        common = {
            "owner": LOCAL_KEY_ID,
            "kind": "painting",
            "status": "succeeded",
            "sources": {},
            "notes": {},
            "progress": {},
        }
        job = Job(
            id=new_id(),
            title="Ὀδυσσεύς",
            inputs={"photo": [file.id], "driver": "me/happy"},
            options={"motion": "walk"},
            created_at=moment,
            enqueued_at=moment,
            **common,
        )
        search.describe(session, job, kind)
        session.add(job)
    for query, there in {
        "été": True,
        "ὀδυσσεύσ": True,
        "me/happy": True,
        "WALK x.png": True,
        "painting": True,
        "\\": False,
        "été%odysseus": False,
        "_": False,
        "run": False,
    }.items():
        with database.read() as session:
            jobs = repository.page(session, LOCAL_KEY_ID, 10, words=search.search_words(query))
        assert bool(jobs) is there, query
    with database.write() as session:
        search.retitle(repository.get_locked(session, job.id), "Penelope")  # type: ignore[arg-type]
    with database.read() as session:
        assert repository.page(session, LOCAL_KEY_ID, 10, words=search.search_words("penelope été walk"))
        assert not repository.page(session, LOCAL_KEY_ID, 10, words=search.search_words("ὀδυσσεύσ"))


def test_a_job_is_not_found_by_the_name_of_somebody_else_s_file(database: Database) -> None:
    kind = Kind("painting", "", [Input("photo", "image", "")], None, None)  # type: ignore[arg-type]
    moment = now()
    with database.write() as session:
        other, _ = create(session, KeyIn(name="other"))
        session.flush()
        files = [
            File(id=new_id(), owner=owner, name=name, content_type="image/png", size=1, sha256="", created_at=moment)
            for owner, name in ((LOCAL_KEY_ID, "rome.png"), (other.id, "secret.png"))
        ]
        session.add_all(files)
        session.flush()
        job = Job(
            id=new_id(),
            **{"owner": LOCAL_KEY_ID, "kind": "painting", "status": "queued", "sources": {}, "notes": {}},
            **{"progress": {}, "options": {}, "inputs": {"photo": [file.id for file in files]}},
            **{"created_at": moment, "enqueued_at": moment},
        )
        search.describe(session, job, kind)
        assert job.search.split() == ["painting", "rome.png"]
