"""The course of a job in SQL: claims, fences, fruitless attempts."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

import pytest

from service.clock import now
from service.context import Context
from service.events import repository as events
from service.ids import new_id
from service.job_records import jobs as repository
from service.jobs import fair_queue, leases
from service.jobs.leases import Lease
from service.tables.jobs import Job, Priority, Status
from service.tables.keys import Key
from service.vault import Secret
from worker.periodic.sweep import take_back_expired


@pytest.fixture
def context(context_on_any: Context) -> Context:
    return context_on_any


@pytest.fixture
def job_id(context: Context) -> str:
    job = Job(
        id=new_id(),
        **{
            "owner": "local",
            "kind": "tiny",
            "status": "queued",
            "inputs": {},
            "sources": {},
            "options": {},
            "notes": {},
        },
        **{"progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with context.database.write() as session:
        session.add(job)
    return job.id


def waiting(context: Context, priority: Priority = Priority.NORMAL, owner: str = "local", kind: str = "tiny") -> str:
    """A further job that waits."""
    job = Job(
        id=new_id(),
        **{"owner": owner, "kind": kind, "status": "queued", "priority": priority, "inputs": {}, "sources": {}},
        **{"options": {}, "notes": {}, "progress": {}, "created_at": now(), "enqueued_at": now()},
    )
    with context.database.write() as session:
        session.add(job)
    return job.id


def claim(context: Context, job_id: str, seconds: float = 30) -> Lease | None:
    with context.database.write() as session:
        return leases.claim(session, job_id, "somebody", seconds)


def status(context: Context, job_id: str) -> tuple[str, int]:
    with context.database.read() as session:
        job = repository.get(session, job_id)
    assert job is not None
    return job.status, job.fruitless_attempts


def test_a_message_that_comes_many_times_runs_once(context: Context, job_id: str) -> None:
    with ThreadPoolExecutor(8) as pool:
        claims = list(pool.map(lambda _: claim(context, job_id), range(8)))
    assert sum(lease is not None for lease in claims) == 1


def test_a_worker_that_was_replaced_can_change_nothing(context: Context, job_id: str) -> None:
    old = claim(context, job_id)
    assert old is not None
    with context.database.write() as session:
        assert leases.give_back(session, old, "it fell silent") == Status.QUEUED
    new = claim(context, job_id)
    assert new is not None and new.token > old.token
    with context.database.write() as session:
        assert not leases.is_held(session, old)
        assert not leases.report_progress(session, old, {"stage": "x", "fraction": 0.5})
        assert not leases.note_new_stage(session, old)
        assert not leases.succeed(session, old)
        assert not leases.fail(session, old, "code", "detail")
        assert leases.give_back(session, old, "late") is None
        assert leases.is_held(session, new)
    assert status(context, job_id) == ("running", 2)


def test_three_fruitless_attempts_in_a_row_fail_the_job(context: Context, job_id: str) -> None:
    for expected in (Status.QUEUED, Status.QUEUED, Status.FAILED):
        lease = claim(context, job_id)
        assert lease is not None
        with context.database.write() as session:
            assert leases.give_back(session, lease, "it died") == expected
    with context.database.read() as session:
        job = repository.get(session, job_id)
    assert job is not None and job.error is not None
    assert job.error["code"] == "attempts_exhausted" and "it died" in job.error["detail"]


def places(context: Context, *jobs: str) -> list[int | None]:
    with context.database.read() as session:
        found = repository.queue_places(
            session, [job for one in jobs if (job := repository.get(session, one)) is not None]
        )
    return [found.get(one) for one in jobs]


def test_the_place_in_the_queue_is_the_order_in_which_jobs_are_taken(context: Context, job_id: str) -> None:
    with context.database.write() as session:
        for name in ("key1", "key2"):
            secrets = {"token_hash": name, "signing_secret": Secret(name), "link_secret": Secret(name)}
            session.add(Key(id=name, name=name, hint="", scopes=[], created_at=now(), **secrets))
    assert claim(context, job_id) is not None  # one of `local` runs
    jobs = [waiting(context, owner=owner) for owner in ("local", "local", "key1", "key1", "key1", "key2")]
    jobs += [waiting(context, Priority.LOW, "key2"), waiting(context, Priority.HIGH, "local")]
    other = waiting(context, kind="other")
    told = places(context, *jobs, other, job_id)
    assert (told.pop(), told.pop()) == (None, 1), "one that runs has none; another kind has a queue of its own"
    assert sorted(told, key=lambda place: place or 0) == list(range(1, 9))
    with context.database.write() as session:
        taken = [fair_queue.claim_next(session, "tiny", "somebody", 30) for _ in jobs]
    order = [lease.job_id for lease in taken if lease is not None]
    assert told == [order.index(job) + 1 for job in jobs]


def test_progress_keeps_the_stages_and_tells_who_follows_of_each_once(context: Context, job_id: str) -> None:
    lease = claim(context, job_id)
    assert lease is not None
    with context.database.write() as session:
        leases.report_progress(session, lease, {"stage": "a", "fraction": 0.1}, ["a"], begun=True)
        leases.report_progress(session, lease, {"stage": "a", "fraction": 0.2}, ["a"])
        leases.report_progress(session, lease, {"stage": "b", "fraction": 0.3}, ["a", "b"], begun=True)
        assert leases.succeed(session, lease)
    with context.database.read() as session:
        job = repository.get(session, job_id)
        told = [
            event.data.get("stages") for event in events.events_after(session, job_id, 0) if event.type == "progress"
        ]
    assert job is not None and job.progress["stages"] == ["a", "b"]
    assert told == [["a"], None, ["a", "b"]]


def test_a_process_that_dies_twice_alike_without_getting_further_is_not_tried_again(
    context: Context, job_id: str
) -> None:
    def ends(death: str | None, fruit: bool = False, counts: bool = True) -> Status | None:
        lease = claim(context, job_id)
        assert lease is not None
        with context.database.write() as session:
            if fruit:
                leases.note_new_stage(session, lease)
            return leases.give_back(session, lease, "a library gave up", counts, death=death)

    assert ends("SIGABRT") == Status.QUEUED
    assert ends("SIGSEGV") == Status.QUEUED, "another death"
    assert ends("SIGSEGV", fruit=True) == Status.QUEUED, "it got further"
    assert ends(None, counts=False) == Status.QUEUED, "the worker was told to stop: that changes nothing"
    assert ends("SIGSEGV") == Status.FAILED
    with context.database.read() as session:
        job = repository.get(session, job_id)
    assert job is not None and job.error is not None
    assert job.error["code"] == "process_died" and "a library gave up" in job.error["detail"]


def test_a_stored_stage_begins_the_count_anew(context: Context, job_id: str) -> None:
    for _ in range(6):
        lease = claim(context, job_id)
        assert lease is not None
        with context.database.write() as session:
            assert leases.note_new_stage(session, lease)
            assert leases.give_back(session, lease, "it died") == Status.QUEUED


def test_an_attempt_that_was_told_to_stop_does_not_count(context: Context, job_id: str) -> None:
    for _ in range(5):
        lease = claim(context, job_id)
        assert lease is not None
        with context.database.write() as session:
            assert leases.give_back(session, lease, "told to stop", counts=False) == Status.QUEUED
    assert status(context, job_id) == ("queued", 0)


def test_the_sweep_takes_back_what_a_silent_worker_held(context: Context, job_id: str) -> None:
    assert claim(context, job_id, seconds=30) is not None
    take_back_expired(context)
    assert status(context, job_id) == ("running", 1)
    with context.database.write() as session:
        session.get_one(Job, job_id).lease_expires_at = now() - timedelta(seconds=1)
    take_back_expired(context)
    assert status(context, job_id) == ("queued", 1)


def test_a_canceled_job_cannot_be_claimed_or_finished(context: Context, job_id: str) -> None:
    lease = claim(context, job_id)
    assert lease is not None
    with context.database.write() as session:
        assert leases.cancel(session, job_id)
        assert not leases.succeed(session, lease)
        assert not leases.cancel(session, job_id)
    assert claim(context, job_id) is None
    assert status(context, job_id)[0] == "canceled"


def claim_next(context: Context, kind: str = "tiny") -> str | None:
    with context.database.write() as session:
        lease = fair_queue.claim_next(session, kind, "somebody", 30)
    return lease.job_id if lease is not None else None


def test_the_most_urgent_comes_first_and_then_the_oldest(context: Context) -> None:
    low, first, second, high = (
        waiting(context, priority) for priority in (Priority.LOW, Priority.NORMAL, Priority.NORMAL, Priority.HIGH)
    )
    other = waiting(context, Priority.HIGH, kind="other")
    assert [claim_next(context) for _ in range(5)] == [high, first, second, low, None]
    assert claim_next(context, "other") == other


def test_keys_have_their_turns(context: Context) -> None:
    """Whoever submits a hundred jobs does not keep the others waiting for all of them."""
    with context.database.write() as session:
        for name in ("a", "b"):
            secrets = {"signing_secret": Secret("s"), "link_secret": Secret("l")}
            session.add(Key(id=name, name=name, hint="", scopes=[], created_at=now(), **secrets))
    many = [waiting(context, owner="a") for _ in range(4)]
    few = [waiting(context, owner="b") for _ in range(2)]
    assert [claim_next(context) for _ in range(6)] == [many[0], few[0], many[1], few[1], many[2], many[3]]


def test_many_workers_take_each_job_once(context: Context) -> None:
    jobs = [waiting(context) for _ in range(12)]
    with ThreadPoolExecutor(6) as pool:
        taken = list(pool.map(lambda _: claim_next(context), range(14)))
    assert sorted(one for one in taken if one is not None) == sorted(jobs)
