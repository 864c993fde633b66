"""What clients can do with webhooks: endpoints, secrets, trying one, sending again."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import timedelta

from sqlalchemy.orm import Session

from service.auth import repository as keys
from service.auth.tokens import new_signing_secret
from service.clock import now
from service.ids import is_id, new_id
from service.outbound.address import AddressRefused, Network, require_callable
from service.problems import FieldError, Problem
from service.tables.webhooks import TEST_EVENT, Delivery, DeliveryStatus, Webhook
from service.webhooks import repository
from service.webhooks.outbox import Destination, new_delivery
from service.webhooks.schemas import WebhookChange, WebhookIn

MAX_ENDPOINTS = 50


def require_address(url: str, allowed: Sequence[Network], pointer: str = "/url") -> None:
    """Raise a 422 problem if an address can be seen to be none that may be called."""
    try:
        require_callable(url, allowed)
    except AddressRefused as refused:
        error = FieldError(pointer=pointer, code="webhook_url_refused", detail=str(refused))
        raise Problem(422, "webhook_url_refused", str(refused), [error]) from refused


def create(session: Session, owner: str, requested: WebhookIn, allowed: Sequence[Network]) -> Webhook:
    """Make an endpoint. Raises `Problem`."""
    require_address(requested.url, allowed)
    keys.get_locked(session, owner)  # so that two requests at the same moment cannot both be the last
    if repository.count(session, owner) >= MAX_ENDPOINTS:
        raise Problem(409, "too_many_webhooks", f"There may be {MAX_ENDPOINTS} endpoints: delete one of them first.")
    webhook = Webhook(
        id=new_id(),
        owner=owner,
        url=requested.url,
        events=list(requested.events),
        description=requested.description,
        enabled=requested.enabled,
        secret=new_signing_secret(),
        given_up=0,
        created_at=now(),
    )
    session.add(webhook)
    return webhook


def change(
    session: Session, owner: str, webhook_id: str, requested: WebhookChange, allowed: Sequence[Network]
) -> Webhook:
    """Change an endpoint. Raises `Problem`."""
    webhook = found(session, owner, webhook_id)
    if requested.url is not None:
        require_address(requested.url, allowed)
        webhook.url = requested.url
    if requested.events is not None:
        webhook.events = list(requested.events)
    if requested.description is not None:
        webhook.description = requested.description
    if requested.enabled is not None and requested.enabled != webhook.enabled:
        webhook.enabled, webhook.disabled_code = requested.enabled, None
        webhook.disabled_at = None if requested.enabled else now()
        webhook.failing_since, webhook.given_up = None, 0  # it gets a fresh chance
    return webhook


def rotate(session: Session, owner: str, webhook_id: str, overlap: timedelta) -> Webhook:
    """Give an endpoint a new secret; the old one signs beside it for a while. Raises `Problem`."""
    webhook = found(session, owner, webhook_id)
    if webhook.secret.clear is None:  # so that an endpoint whose secret is lost can be had to work again
        webhook.previous_secret = webhook.previous_until = None
    else:
        webhook.previous_secret, webhook.previous_until = webhook.secret, now() + overlap
    webhook.secret = new_signing_secret()
    return webhook


def test(session: Session, owner: str, webhook_id: str) -> Delivery:
    """Write a message that tells of nothing, to try an endpoint. Raises `Problem`."""
    webhook = found(session, owner, webhook_id)
    _require_enabled(webhook)
    payload: dict[str, object] = {"webhook_id": webhook.id, "message": "This is a test."}
    message = new_delivery(owner, Destination(webhook.id, webhook.url), TEST_EVENT, payload)
    message.created_at = message.next_attempt_at = now()
    session.add(message)
    return message


def replay(session: Session, owner: str, delivery_id: str) -> Delivery:
    """Send a message again, now, under its old `webhook-id`; the schedule begins anew. Raises `Problem`."""
    message = found_delivery(session, owner, delivery_id)
    if message.webhook_id is not None:
        _require_enabled(found(session, owner, message.webhook_id))
    message.status, message.next_attempt_at, message.tries = DeliveryStatus.PENDING, now(), 0
    return message


def found(session: Session, owner: str, webhook_id: str) -> Webhook:
    """An owner's endpoint, or a 404 problem."""
    webhook = repository.get(session, owner, webhook_id) if is_id(webhook_id) else None
    if webhook is None:
        raise Problem(404, "webhook_not_found", "There is no such endpoint: it was deleted, or it never was.")
    return webhook


def found_delivery(session: Session, owner: str, delivery_id: str) -> Delivery:
    """An owner's delivery, or a 404 problem."""
    message = repository.delivery(session, owner, delivery_id) if is_id(delivery_id) else None
    if message is None:
        raise Problem(404, "delivery_not_found", "There is no such delivery: it has had its time, or it never was.")
    return message


def _require_enabled(webhook: Webhook) -> None:
    if not webhook.enabled:
        raise Problem(409, "webhook_disabled", "The endpoint is disabled: enable it first.")
