"""Whoever is shown a job that is queued is told its place, and of no other job: whatever is asked, at whatever moment."""

from __future__ import annotations

from typing import Any

from running import Running
from sqlalchemy import select

from service.clock import now
from service.context import Context
from service.ids import new_id
from service.job_records import jobs, owned
from service.jobs import fair_queue, leases
from service.tables.jobs import Job
from service.tables.webhooks import Delivery


def agrees(job: dict[str, Any]) -> bool:
    return (job["status"] == "queued") == (job["queue_position"] is not None)


def test_every_answer_about_a_job_has_its_place_while_it_is_queued(running: Running, picture: bytes) -> None:
    """Jobs that a worker takes at once, asked for in every manner as fast as possible."""
    file = running.client.post("/v1/files", files={"file": ("p.png", picture)}).raise_for_status().json()["id"]
    body = {"kind": "tiny", "inputs": {"image": file}, "options": {"seconds": 0}}
    done = running.until(running.submit(picture)["id"], "succeeded")["id"]
    for number in range(12):
        once = {"Idempotency-Key": f"place-{number}"}
        made = running.client.post("/v1/jobs", json=body, headers=once)
        again = running.client.post("/v1/jobs", json=body, headers=once)
        assert again.headers["idempotent-replayed"] == "true"
        form = running.client.post("/v1/jobs", data={"kind": "tiny"}, files={"image": ("p.png", picture)})
        revised = running.client.post(f"/v1/jobs/{done}/revisions", json={})
        retitled = running.client.patch(f"/v1/jobs/{made.json()['id']}", json={"title": "a"})
        tree = running.client.get(f"/v1/jobs/{done}/revisions").json()["items"]
        listed = running.client.get("/v1/jobs", params={"limit": 5}).json()["items"]
        for answer in (made, form, revised):
            assert answer.status_code == 202 and answer.json()["status"] == "queued"
        shown = [answer.json() for answer in (made, again, form, revised, retitled)] + tree + listed
        assert all(map(agrees, shown)), shown
        canceled = running.client.post(f"/v1/jobs/{revised.json()['id']}/cancel")
        assert canceled.status_code == 409 or agrees(canceled.json())


def waiting(context: Context, **more: Any) -> str:
    """The id of a job that waits."""
    job = Job(
        **{"id": new_id(), "owner": "local", "kind": "tiny", "status": "queued", "inputs": {}, "sources": {}},
        **{"options": {}, "notes": {}, "progress": {}, "created_at": now(), "enqueued_at": now()},
        **more,
    )
    with context.database.write() as session:
        session.add(job)
    return job.id


def test_a_job_that_a_worker_took_before_the_answer_was_written_was_the_next(context: Context) -> None:
    with context.database.read() as session:
        job = jobs.get(session, waiting(context))
    assert job is not None
    with context.database.write() as session:
        assert fair_queue.claim_next(session, "tiny", "a worker", 30) is not None
    assert owned.queue_place(context, job) == 1
    shown = owned.job_view(context, "local", job.id)
    assert (shown.status, shown.queue_position) == ("running", None)


def test_webhooks_about_a_job_that_waits_tell_its_place_too(context: Context) -> None:
    waiting(context)
    job = waiting(context, webhook_url="https://example.org/", webhook_events=["job.progress"])
    with context.database.write() as session:
        assert leases.note_waiting(session, job, {"stage": "prepare_engine", "message": "once"})
    with context.database.read() as session:
        (told,) = session.scalars(select(Delivery.payload))
    assert (told["status"], told["queue_position"]) == ("queued", 2)
