"""Webhooks as the API takes and shows them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, Field, Strict

from service.http.request_models import REQUEST_MODEL
from service.tables.webhooks import (
    FINAL_EVENTS,
    URL_CHARACTERS,
    Delivery,
    DeliveryAttempt,
    DeliveryStatus,
    EventType,
    Webhook,
)


def _once(events: list[EventType]) -> list[EventType]:
    return [type_ for type_ in EventType if type_ in events]


Url = Annotated[str, Field(min_length=1, max_length=URL_CHARACTERS)]
Events = Annotated[
    list[Annotated[EventType, Strict(False)]], Field(fail_fast=True, min_length=1, max_length=20), AfterValidator(_once)
]
Description = Annotated[str, Field(max_length=500, pattern=r"^[^\x00]*$")]
Told = EventType | Literal["webhook.test"]
"""All that an address can be told."""


class WebhookIn(BaseModel):
    """An endpoint to be told of jobs."""

    model_config = REQUEST_MODEL

    url: Url
    """Begins with `https://`; with `http://` only where the operator allows the network."""
    events: Events = list(FINAL_EVENTS)
    description: Description = ""
    enabled: bool = True


class WebhookChange(BaseModel):
    """What is to be different about an endpoint; what is left out stays."""

    model_config = REQUEST_MODEL

    url: Url | None = None
    events: Events | None = None
    description: Description | None = None
    enabled: bool | None = None
    """True takes up again what was still to be delivered."""


class Disabled(BaseModel):
    """Why an endpoint takes no messages."""

    code: Literal["gone", "failing", "by_owner"]
    at: datetime | None


class WebhookOut(BaseModel):
    """An endpoint."""

    id: str
    url: str
    events: list[EventType]
    description: str
    enabled: bool
    disabled: Disabled | None
    """`gone`: it answered 410. `failing`: nothing came through for five days. `by_owner`: by a change."""
    failing_since: datetime | None
    """The first attempt that failed since the last one that succeeded."""
    created_at: datetime

    @classmethod
    def of(cls, webhook: Webhook) -> WebhookOut:
        disabled = None
        if not webhook.enabled:
            code = webhook.disabled_code or "by_owner"
            disabled = Disabled.model_validate({"code": code, "at": webhook.disabled_at})
        return cls(
            id=webhook.id,
            url=webhook.url,
            events=[EventType(event) for event in webhook.events],
            description=webhook.description,
            enabled=webhook.enabled,
            disabled=disabled,
            failing_since=webhook.failing_since,
            created_at=webhook.created_at,
        )


class NewWebhookOut(WebhookOut):
    """An endpoint that was just made, with the secret that signs what it is told."""

    secret: str


class WebhookList(BaseModel):
    """All endpoints, oldest first."""

    items: list[WebhookOut]


class RotationIn(BaseModel):
    """How an endpoint's secret is replaced."""

    model_config = REQUEST_MODEL

    overlap_hours: float = Field(default=24, ge=0, le=168)
    """How long the old secret signs beside the new one."""


class SecretOut(BaseModel):
    """The secrets that sign for an endpoint."""

    secret: str
    previous_secret: str | None
    previous_until: datetime | None
    """Until then messages carry a signature by the previous secret too."""

    @classmethod
    def of(cls, webhook: Webhook, moment: datetime) -> SecretOut:
        live = webhook.previous_until is not None and webhook.previous_until > moment
        previous = webhook.previous_secret if live else None
        return cls(
            secret=webhook.secret.reveal(),
            previous_secret=previous.reveal() if previous is not None else None,
            previous_until=webhook.previous_until if live else None,
        )


class DeliveryError(BaseModel):
    """Why an attempt failed."""

    code: str
    detail: str


class AttemptOut(BaseModel):
    """One attempt."""

    started_at: datetime
    seconds: float
    response_status: int | None
    """Null where there was no answer."""
    response_excerpt: str
    """The answer's first bytes as text."""
    error: DeliveryError | None

    @classmethod
    def of(cls, attempt: DeliveryAttempt) -> AttemptOut:
        error = None
        if attempt.error_code is not None:
            error = DeliveryError(code=attempt.error_code, detail=attempt.error_detail or "")
        return cls(
            started_at=attempt.started_at,
            seconds=round(attempt.seconds, 3),
            response_status=attempt.response_status,
            response_excerpt=attempt.response_excerpt,
            error=error,
        )


class DeliveryOut(BaseModel):
    """A message for one address."""

    id: str
    """Also the message's `webhook-id`."""
    webhook_id: str | None
    """Null where the job named the address itself."""
    job_id: str | None
    """Null for a test."""
    event: Told
    url: str
    status: DeliveryStatus
    created_at: datetime
    next_attempt_at: datetime | None
    """Null once nothing more will be tried. While the endpoint is disabled, nothing is."""
    delivered_at: datetime | None
    attempts: int
    last_attempt: AttemptOut | None

    @classmethod
    def of(cls, delivery: Delivery, attempts: Sequence[DeliveryAttempt]) -> DeliveryOut:
        return cls(**_fields(delivery, attempts))


class DeliveryDetail(DeliveryOut):
    """A message for one address, with what it says and all attempts, oldest first."""

    data: dict[str, Any]
    history: list[AttemptOut]

    @classmethod
    def of(cls, delivery: Delivery, attempts: Sequence[DeliveryAttempt]) -> DeliveryDetail:
        return cls(data=delivery.payload, history=list(map(AttemptOut.of, attempts)), **_fields(delivery, attempts))


class DeliveryPage(BaseModel):
    """Deliveries, newest first."""

    items: list[DeliveryOut]
    next_cursor: str | None
    """Give it as `cursor` to get the next page; null on the last one."""


def _fields(delivery: Delivery, attempts: Sequence[DeliveryAttempt]) -> dict[str, Any]:
    return {
        "id": delivery.id,
        "webhook_id": delivery.webhook_id,
        "job_id": delivery.job_id,
        "event": delivery.event,
        "url": delivery.url,
        "status": DeliveryStatus(delivery.status),
        "created_at": delivery.created_at,
        "next_attempt_at": delivery.next_attempt_at,
        "delivered_at": delivery.delivered_at,
        "attempts": len(attempts),
        "last_attempt": AttemptOut.of(attempts[-1]) if attempts else None,
    }
