"""Which of the clips that jobs were made of go once one of these has succeeded."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from sqlalchemy.orm import Session
from tiny_kind import PERSON

from engine.kind import Input
from service.clock import now
from service.context import Context
from service.ids import new_id
from service.jobs.source_erasure import erase_sources
from service.tables.files import File
from service.tables.jobs import Job, JobFile

FILMED = replace(PERSON, inputs=(*PERSON.inputs, Input("motion", "motion", "how they move", required=False)))
"""Made of a picture of somebody, which is personal, and of a motion, which is not."""


@pytest.fixture
def session(context: Context) -> Any:
    with context.database.write() as opened:
        yield opened


def file(session: Session, name: str) -> File:
    stored = {"content_type": "image/png", "size": 3, "sha256": name.ljust(64, "0"), "created_at": now()}
    made = File(id=new_id(), owner="local", name=name, **stored)
    session.add(made)
    session.flush()
    return made


def job(session: Session, status: str, tree: str | None = None, **files: File) -> Job:
    sources = {name: {"file": one.id} for name, one in files.items()}
    made = Job(
        id=(own := new_id()),
        owner="local",
        **{"kind": "person", "status": status, "tree": tree or own, "inputs": {}, "sources": sources, "options": {}},
        **{"notes": {}, "progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    session.add(made)
    session.flush()
    session.add_all([JobFile(job_id=made.id, file_id=one) for one in {one.id for one in files.values()}])
    session.flush()
    return made


def test_a_version_that_still_runs_keeps_its_picture_until_it_has_ended_too(session: Session) -> None:
    picture = file(session, "a")
    first = job(session, "failed", image=picture)
    running = job(session, "running", first.tree, image=picture)
    done = job(session, "succeeded", first.tree, image=picture)
    assert erase_sources(session, PERSON, done.id) == []
    assert first.sources == done.sources == {"image": {"erased": picture.sha256}}
    assert running.sources == {"image": {"file": picture.id}}
    running.status = "succeeded"
    assert erase_sources(session, PERSON, running.id) == [picture]
    assert running.sources == {"image": {"erased": picture.sha256}}


def test_what_is_personal_goes_and_the_rest_stays(session: Session) -> None:
    picture, motion = file(session, "a"), file(session, "b")
    done = job(session, "succeeded", image=picture, motion=motion)
    assert erase_sources(session, FILMED, done.id) == [picture]
    assert done.sources == {"image": {"erased": picture.sha256}, "motion": {"file": motion.id}}


def test_a_file_that_the_job_uses_as_something_else_as_well_stays_for_that(session: Session) -> None:
    both = file(session, "a")
    done = job(session, "succeeded", image=both, motion=both)
    assert erase_sources(session, FILMED, done.id) == []
    assert done.sources == {"image": {"erased": both.sha256}, "motion": {"file": both.id}}
    assert session.get(JobFile, (done.id, both.id)) is not None
