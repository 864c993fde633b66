"""/webhooks: endpoints and their secrets, deliveries, replay."""

from __future__ import annotations

from datetime import timedelta
from typing import Annotated

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from service.auth.caller import Reader, Submitter
from service.clock import now
from service.http.json_bodies import RequestModelRoute
from service.ids import LIKE_AN_ID, is_id
from service.problems import Problem, responses
from service.request_context import InContext
from service.tables.webhooks import Delivery, DeliveryStatus
from service.webhooks import repository, service
from service.webhooks.repository import DeliveryFilter
from service.webhooks.schemas import (
    DeliveryDetail,
    DeliveryOut,
    DeliveryPage,
    NewWebhookOut,
    RotationIn,
    SecretOut,
    Told,
    WebhookChange,
    WebhookIn,
    WebhookList,
    WebhookOut,
)

router = APIRouter(prefix="/webhooks", tags=["webhooks"], route_class=RequestModelRoute)


@router.get("", operation_id="list_webhooks")
def list_webhooks(caller: Reader, context: InContext) -> WebhookList:
    """All endpoints."""
    with context.database.read() as session:
        return WebhookList(items=[WebhookOut.of(webhook) for webhook in repository.of_owner(session, caller.owner)])


@router.post("", status_code=201, operation_id="create_webhook", responses=responses(409, 422))
def create_webhook(requested: WebhookIn, caller: Submitter, response: Response, context: InContext) -> NewWebhookOut:
    """Have an address told of jobs. The answer carries the secret that signs the messages."""
    with context.database.write() as session:
        webhook = service.create(session, caller.owner, requested, context.settings.allowed_networks)
    response.headers["Location"] = f"/v1/webhooks/{webhook.id}"
    response.headers["Cache-Control"] = "no-store"
    return NewWebhookOut(secret=webhook.secret.reveal(), **WebhookOut.of(webhook).model_dump())


@router.get("/deliveries", operation_id="list_deliveries", responses=responses(422))
def list_deliveries(
    request: Request,
    response: Response,
    caller: Reader,
    context: InContext,
    status: Annotated[list[DeliveryStatus], Query(description="One or several.", max_length=20)] = [],  # noqa: B006
    event: Annotated[list[Told], Query(description="One or several.", max_length=20)] = [],  # noqa: B006
    job: Annotated[str | None, Query(description="The id of a job.")] = None,
    webhook: Annotated[str | None, Query(description="The id of an endpoint.")] = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(json_schema_extra=LIKE_AN_ID)] = None,
) -> DeliveryPage:
    """Deliveries to endpoints and to addresses that jobs named themselves, newest first."""
    if cursor is not None and not is_id(cursor):
        raise Problem(422, "invalid_cursor", "The cursor is not one that a list gave: begin again without it.")
    if any(one is not None and not is_id(one) for one in (job, webhook)):
        return DeliveryPage(items=[], next_cursor=None)
    wanted = DeliveryFilter(status, event, job, webhook)
    with context.database.read() as session:
        found = repository.deliveries(session, caller.owner, wanted, limit + 1, cursor)
        shown = found[:limit]
        attempts = repository.attempts(session, [delivery.id for delivery in shown])
    next_cursor = shown[-1].id if len(found) > limit else None
    if next_cursor is not None:
        following = request.url.include_query_params(cursor=next_cursor)
        response.headers["Link"] = f'<{following.path}?{following.query}>; rel="next"'
    items = [DeliveryOut.of(delivery, attempts.get(delivery.id, [])) for delivery in shown]
    return DeliveryPage(items=items, next_cursor=next_cursor)


@router.get("/deliveries/{delivery_id}", operation_id="get_delivery", responses=responses(404))
def get_delivery(delivery_id: str, caller: Reader, context: InContext) -> DeliveryDetail:
    """A delivery with what it says, and every attempt at it."""
    with context.database.read() as session:
        delivery = service.found_delivery(session, caller.owner, delivery_id)
        return DeliveryDetail.of(delivery, repository.attempts(session, [delivery_id]).get(delivery_id, []))


@router.post(
    "/deliveries/{delivery_id}/replay", status_code=202, operation_id="replay_delivery", responses=responses(404, 409)
)
def replay_delivery(delivery_id: str, caller: Submitter, response: Response, context: InContext) -> DeliveryOut:
    """Send a message again, now, under its old `webhook-id`."""
    with context.database.write() as session:
        delivery = service.replay(session, caller.owner, delivery_id)
        attempts = repository.attempts(session, [delivery_id]).get(delivery_id, [])
    response.headers["Location"] = _location(delivery)
    return DeliveryOut.of(delivery, attempts)


@router.get("/{webhook_id:id}", operation_id="get_webhook", responses=responses(404))
def get_webhook(webhook_id: str, caller: Reader, context: InContext) -> WebhookOut:
    """An endpoint."""
    with context.database.read() as session:
        return WebhookOut.of(service.found(session, caller.owner, webhook_id))


@router.patch("/{webhook_id:id}", operation_id="change_webhook", responses=responses(404, 422))
def change_webhook(webhook_id: str, requested: WebhookChange, caller: Submitter, context: InContext) -> WebhookOut:
    """Change an endpoint; enabling it again takes up what was still to be delivered."""
    with context.database.write() as session:
        return WebhookOut.of(
            service.change(session, caller.owner, webhook_id, requested, context.settings.allowed_networks)
        )


@router.delete("/{webhook_id:id}", status_code=204, operation_id="delete_webhook", responses=responses(404))
def delete_webhook(webhook_id: str, caller: Submitter, context: InContext) -> None:
    """Erase an endpoint with its deliveries."""
    with context.database.write() as session:
        service.found(session, caller.owner, webhook_id)
        repository.erase(session, webhook_id)


@router.get("/{webhook_id:id}/secret", operation_id="get_webhook_secret", responses=responses(404))
def get_webhook_secret(webhook_id: str, caller: Submitter, response: Response, context: InContext) -> SecretOut:
    """The secrets that sign for an endpoint."""
    response.headers["Cache-Control"] = "no-store"
    with context.database.read() as session:
        return SecretOut.of(service.found(session, caller.owner, webhook_id), now())


@router.post("/{webhook_id:id}/secret/rotate", operation_id="rotate_webhook_secret", responses=responses(404, 422))
def rotate_webhook_secret(
    webhook_id: str, caller: Submitter, response: Response, context: InContext, requested: RotationIn | None = None
) -> SecretOut:
    """Give an endpoint a new secret. For a while, messages carry a signature by each of the two."""
    response.headers["Cache-Control"] = "no-store"
    overlap = timedelta(hours=(requested or RotationIn()).overlap_hours)
    with context.database.write() as session:
        return SecretOut.of(service.rotate(session, caller.owner, webhook_id, overlap), now())


@router.post("/{webhook_id:id}/test", status_code=202, operation_id="test_webhook", responses=responses(404, 409))
def test_webhook(webhook_id: str, caller: Submitter, response: Response, context: InContext) -> DeliveryOut:
    """Send an endpoint a message of the type `webhook.test`."""
    with context.database.write() as session:
        delivery = service.test(session, caller.owner, webhook_id)
    response.headers["Location"] = _location(delivery)
    return DeliveryOut.of(delivery, [])


def _location(delivery: Delivery) -> str:
    return f"/v1/webhooks/deliveries/{delivery.id}"
