"""Telling jobs what they wait for, and taking it back."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import pytest

from service.clock import now
from service.context import Context
from service.events import repository as events
from service.ids import new_id
from service.job_records import jobs as repository
from service.jobs import fair_queue, leases
from service.tables.jobs import Job
from worker.compilation.announcement import PREPARING_MESSAGE, PREPARING_STAGE, announce, take_back


@pytest.fixture
def context(context_on_any: Context) -> Context:
    return context_on_any


def waiting(context: Context, kind: str = "tiny", **progress: Any) -> str:
    """A job that has waited for a minute."""
    since = now() - timedelta(minutes=1)
    job = Job(
        id=new_id(),
        **{"owner": "local", "kind": kind, "status": "queued", "inputs": {}, "sources": {}, "options": {}},
        **{"notes": {}, "progress": progress, "created_at": since, "enqueued_at": since},
    )
    with context.database.write() as session:
        session.add(job)
    return job.id


def progress(context: Context, job_id: str) -> dict[str, Any]:
    with context.database.read() as session:
        job = repository.get(session, job_id)
    assert job is not None
    return dict(job.progress)


def told(context: Context, job_id: str) -> int:
    """How often its followers heard of it."""
    with context.database.read() as session:
        return len(events.events_after(session, job_id, 0))


def test_they_are_told_once_and_it_is_taken_back_once(context: Context) -> None:
    job_id = waiting(context, stage="rest", fraction=0.25, message="resting", eta_seconds=3.0)
    announce(context, ["tiny"])
    announce(context, ["tiny"])
    assert progress(context, job_id) == {
        "stage": PREPARING_STAGE,
        "fraction": 0.25,
        "message": PREPARING_MESSAGE,
        "eta_seconds": None,
    }
    assert told(context, job_id) == 1
    take_back(context, ["tiny"])
    take_back(context, ["tiny"])
    assert progress(context, job_id) == {"stage": None, "fraction": 0.25, "message": "", "eta_seconds": None}
    assert told(context, job_id) == 2


def test_where_one_of_their_kind_runs_they_wait_for_their_turn(context: Context) -> None:
    other = waiting(context, kind="other")
    waiting(context)
    with context.database.write() as session:
        assert fair_queue.claim_next(session, "tiny", "somebody", 30) is not None
    behind = waiting(context)
    announce(context, ["tiny", "other"])
    assert progress(context, behind) == {}
    assert progress(context, other)["stage"] == PREPARING_STAGE


def test_what_others_serve_and_what_runs_is_left_alone(context: Context) -> None:
    others, taken = waiting(context, kind="other"), waiting(context)
    announce(context, ["tiny"])
    with context.database.write() as session:
        lease = leases.claim(session, taken, "somebody", 30)
        assert lease is not None and leases.report_progress(session, lease, {"stage": "rest", "fraction": 0.5})
        assert not leases.note_waiting(session, taken, {})
    take_back(context, ["tiny"])
    assert progress(context, taken) == {"stage": "rest", "fraction": 0.5, "stages": []}
    assert progress(context, others) == {}
