"""The course of a delivery, as workers change it: claimed for one attempt by a lease, then settled.

A worker that dies in between leaves a lease that expires: the delivery is tried again. So each is delivered at least
once, and two attempts at one never run at the same time.

The moment is always given. Workers give the database's (`database_now`), for their own clocks may differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta
from random import Random

from sqlalchemy import ColumnElement, Select, func, literal, or_, select, update
from sqlalchemy.orm import Session

from service.figures import counters
from service.job_records.signed_links import Signer
from service.settings import Settings
from service.tables.base import UTCDateTime, moment_in
from service.tables.jobs import Job
from service.tables.keys import Key
from service.tables.webhooks import Delivery, DeliveryAttempt, DeliveryStatus, Webhook
from service.vault import SecretUnreadable
from service.webhooks import schedule
from service.webhooks.message import body
from service.webhooks.signing import live_secrets

UNREADABLE_CODE = "secret_unreadable"
"""The code of an attempt that could not be signed."""

SET_BACK = timedelta(minutes=10)
"""A lease that ends so much later than it could was given before the clock was set back. Less than that is no proof:
whoever asks may have looked at the clock a while ago."""


@dataclass(frozen=True)
class Claim:
    """The right to make one attempt, and all that is needed for it."""

    delivery_id: str
    token: int
    url: str
    secrets: tuple[str, ...]
    body: str
    event: str
    job_id: str | None
    request: str | None
    """The id of the request that submitted the job."""
    trace: str | None
    """The span of the request that submitted the job, as a `traceparent`."""
    fault: str | None = None
    """Why nothing can be sent, for there are no secrets to sign it with."""


@dataclass(frozen=True)
class Outcome:
    """What came of an attempt."""

    seconds: float
    status: int | None = None
    """None where there was no answer."""
    excerpt: str = ""
    code: str | None = None
    """None where it succeeded."""
    detail: str | None = None
    retry_after: timedelta | None = None
    """What the receiver asked for."""

    @property
    def gone(self) -> bool:
        """Whether the receiver wants nothing any more."""
        return self.status == 410


def database_now(session: Session) -> datetime:
    """Now, by the database's clock."""
    return session.scalars(select(moment_in())).one()


def any_due(session: Session, settings: Settings, moment: datetime) -> bool:
    """Whether there is anything to claim; reads only."""
    return session.scalar(_next(settings, moment)) is not None


def claim(session: Session, settings: Settings, moment: datetime) -> Claim | None:
    """Take what is due and has waited longest; None if there is nothing.

    A host to which half of the attempts at once go already is passed over, so that a slow one holds up nobody else.
    """
    while (delivery := session.scalar(_next(settings, moment))) is not None:
        taken = session.execute(
            update(Delivery)
            .where(Delivery.id == delivery.id, Delivery.lease_token == delivery.lease_token, _free(settings, moment))
            .values(lease_token=Delivery.lease_token + 1, lease_expires_at=moment + _lease(settings))
        )
        if taken.rowcount:  # type: ignore[attr-defined]
            return _claim(session, settings, delivery.id, moment)
    return None


def settle(session: Session, claimed: Claim, outcome: Outcome, moment: datetime, chance: Random) -> bool:
    """Record what came of an attempt, and what follows from it. Returns False if the lease was lost."""
    delivery = session.scalar(
        select(Delivery)
        .where(Delivery.id == claimed.delivery_id, Delivery.lease_token == claimed.token)
        .with_for_update()
        .execution_options(populate_existing=True)
    )
    if delivery is None or delivery.lease_expires_at is None:
        return False
    delivery.lease_expires_at = None
    session.add(
        DeliveryAttempt(
            delivery_id=delivery.id,
            started_at=moment - timedelta(seconds=outcome.seconds),
            seconds=outcome.seconds,
            response_status=outcome.status,
            response_excerpt=outcome.excerpt,
            error_code=outcome.code,
            error_detail=outcome.detail,
        )
    )
    session.flush()
    counters.add(session, "galatea_webhook_attempts", delivery.event, outcome.code or "delivered")
    if outcome.code is None:
        _succeed(session, delivery, moment)
    else:
        _fail(session, delivery, outcome, moment, chance)
    return True


def _next(settings: Settings, moment: datetime) -> Select[Delivery]:
    most = max(1, settings.webhook_concurrency // 2)
    busy = (
        select(Delivery.host)
        .where(Delivery.status == DeliveryStatus.PENDING, ~_free(settings, moment))
        .group_by(Delivery.host)
        .having(func.count() >= most)
    )
    return (
        select(Delivery)
        .outerjoin(Webhook, Webhook.id == Delivery.webhook_id)
        .where(
            Delivery.status == DeliveryStatus.PENDING,
            _waited(moment),
            _free(settings, moment),
            or_(Delivery.webhook_id.is_(None), Webhook.enabled),
            Delivery.host.not_in(busy),
        )
        .order_by(Delivery.next_attempt_at, Delivery.id)
        .limit(1)
        .execution_options(populate_existing=True)
    )


def _waited(moment: datetime) -> ColumnElement[bool]:
    """That the next attempt is due. The first one always is, and so is one that lies further ahead than any pause: the
    clock was set back since."""
    return or_(
        Delivery.next_attempt_at <= moment,
        Delivery.tries == 0,
        Delivery.next_attempt_at > moment + schedule.MAX_PAUSE,
    )


def _free(settings: Settings, moment: datetime) -> ColumnElement[bool]:
    """That nobody else tries."""
    return or_(
        Delivery.lease_expires_at.is_(None),
        Delivery.lease_expires_at <= moment,
        Delivery.lease_expires_at > moment + _lease(settings) + SET_BACK,
    )


def _lease(settings: Settings) -> timedelta:
    """Twice as long as an attempt can take."""
    return timedelta(seconds=2 * settings.webhook_seconds)


def _claim(session: Session, settings: Settings, delivery_id: str, moment: datetime) -> Claim:
    delivery = session.get_one(Delivery, delivery_id, populate_existing=True)
    key = session.get_one(Key, delivery.owner)
    job = session.get(Job, delivery.job_id) if delivery.job_id is not None else None
    webhook = session.get_one(Webhook, delivery.webhook_id) if delivery.webhook_id is not None else None
    secrets, said, fault = tuple[str, ...](), "", None
    try:
        secrets = live_secrets(webhook, moment) if webhook is not None else (key.signing_secret.reveal(),)
        said = body(delivery, Signer.of(key, settings), settings.public_url)
    except SecretUnreadable as error:
        fault = str(error)
    return Claim(
        delivery_id=delivery.id,
        token=delivery.lease_token,
        url=webhook.url if webhook is not None else delivery.url,
        secrets=secrets,
        body=said,
        event=delivery.event,
        job_id=delivery.job_id,
        request=job.request if job is not None else None,
        trace=job.trace if job is not None else None,
        fault=fault,
    )


def _succeed(session: Session, delivery: Delivery, moment: datetime) -> None:
    if delivery.delivered_at is None:
        waited = max((moment - delivery.created_at).total_seconds(), 0.0)
        counters.add(session, "galatea_webhook_seconds", delivery.event, amount=waited)
        counters.add(session, "galatea_webhook_deliveries", delivery.event)
    delivery.status, delivery.next_attempt_at, delivery.delivered_at = DeliveryStatus.DELIVERED, None, moment
    session.execute(
        update(Webhook)
        .where(Webhook.id == delivery.webhook_id, Webhook.failing_since.is_not(None))
        .values(failing_since=None, given_up=0)
    )


def _fail(session: Session, delivery: Delivery, outcome: Outcome, moment: datetime, chance: Random) -> None:
    delivery.tries += 1
    if delivery.status != DeliveryStatus.PENDING:
        return  # given up while this attempt went on
    pause = None if outcome.gone else schedule.retry_delay(delivery.event, delivery.tries, outcome.retry_after, chance)
    delivery.next_attempt_at = None if pause is None else moment + pause
    if pause is None:
        delivery.status = DeliveryStatus.FAILED
    if delivery.webhook_id is not None and outcome.code != UNREADABLE_CODE:  # of that the receiver knows nothing
        _count_failure(session, delivery.webhook_id, outcome.gone, pause is None, moment)
    elif outcome.gone:
        session.execute(
            update(Delivery)
            .where(
                Delivery.job_id == delivery.job_id,
                Delivery.webhook_id.is_(None),
                Delivery.status == DeliveryStatus.PENDING,
            )
            .values(status=DeliveryStatus.FAILED, next_attempt_at=None)
        )


def _count_failure(session: Session, webhook_id: str, gone: bool, given_up: bool, moment: datetime) -> None:
    """Note at the endpoint that an attempt failed, and disable it if that is enough."""
    session.execute(
        update(Webhook)
        .where(Webhook.id == webhook_id)
        .values(
            failing_since=func.coalesce(Webhook.failing_since, literal(moment, UTCDateTime)),
            given_up=Webhook.given_up + int(given_up),
        )
    )
    webhook = session.get_one(Webhook, webhook_id, populate_existing=True)
    if webhook.enabled and (gone or schedule.is_lost(webhook, moment)):
        webhook.enabled, webhook.disabled_at, webhook.disabled_code = False, moment, "gone" if gone else "failing"
