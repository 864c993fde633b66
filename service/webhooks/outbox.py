"""Writing down what is to be delivered, in the same transaction as what it tells of: if that became true, it will be
told, whatever dies in the meantime. Nothing is sent here: the worker does that, by what is written."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta

import httpx
from sqlalchemy import select
from sqlalchemy.orm import Session

from service.ids import new_id
from service.job_records import artifacts, jobs
from service.job_records.schemas import JobOut
from service.tables.events import Event
from service.tables.jobs import Job, Status
from service.tables.webhooks import FINAL_EVENTS, Delivery, DeliveryStatus, EventType
from service.webhooks import repository

PROGRESS_EVERY = timedelta(seconds=5)
"""An address is told of a job's progress no more often than this, and not while the last word is still on its way."""


@dataclass(frozen=True)
class Destination:
    """Where something is told: an endpoint, or the address that the job named itself."""

    webhook_id: str | None
    url: str


def write(session: Session, event: Event) -> None:
    """Write down what is to be told of an event that was just appended, if anybody wants to know."""
    type_ = _type(event)
    if type_ is None:
        return
    job = session.get_one(Job, event.job_id, populate_existing=True)
    destinations = _destinations(session, job, type_)
    if type_ == EventType.PROGRESS:
        destinations = [one for one in destinations if not _told_lately(session, event, one)]
    if not destinations:
        return
    shown = _document(session, job)
    for destination in destinations:
        message = new_delivery(job.owner, destination, type_, shown)
        message.job_id, message.sequence = job.id, event.id
        message.created_at = message.next_attempt_at = event.created_at
        session.add(message)


def _document(session: Session, job: Job) -> dict[str, object]:
    """The job as the API shows it, but for signed links, which would have ended when somebody reads this later."""
    made = artifacts.of_jobs(session, [job.id])[job.id]
    places = jobs.queue_places(session, [job] if job.status == Status.QUEUED else [])
    return JobOut.of(job, made, queue_position=places.get(job.id)).model_dump(mode="json")


def new_delivery(owner: str, destination: Destination, event: str, payload: dict[str, object]) -> Delivery:
    """A delivery that is not written yet; when it is made and due is for the caller to say."""
    return Delivery(
        id=new_id(),
        owner=owner,
        webhook_id=destination.webhook_id,
        event=event,
        url=destination.url,
        host=httpx.URL(destination.url).host[:255],
        payload=payload,
        status=DeliveryStatus.PENDING,
        tries=0,
        lease_token=0,
    )


def _type(event: Event) -> EventType | None:
    if event.type == "progress":
        return EventType.PROGRESS
    if event.type == "status" and Status(event.data["status"]).final:
        return EventType(f"job.{event.data['status']}")
    return None


def _destinations(session: Session, job: Job, type_: EventType) -> list[Destination]:
    found = [
        Destination(webhook.id, webhook.url)
        for webhook in repository.enabled(session, job.owner)
        if type_ in webhook.events
    ]
    if job.webhook_url is not None and type_ in (job.webhook_events or FINAL_EVENTS):
        found.append(Destination(None, job.webhook_url))
    return found


def _told_lately(session: Session, event: Event, destination: Destination) -> bool:
    earlier = (
        select(Delivery.id)
        .where(
            Delivery.job_id == event.job_id,
            Delivery.event == EventType.PROGRESS,
            Delivery.webhook_id.is_not_distinct_from(destination.webhook_id),
            (Delivery.status == DeliveryStatus.PENDING) | (Delivery.created_at > event.created_at - PROGRESS_EVERY),
        )
        .limit(1)
    )
    return session.scalar(earlier) is not None
