"""Who uses a service, and who is told of what happens there: keys and webhooks."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Iterable, Sequence
from functools import partial
from typing import Any

from galatea_client.models import Delivery, Key, NewKey, NewWebhook, OwnKey, Webhook, WebhookSecret
from galatea_client.requests import J, Requests


class Account(Requests[J]):
    """The methods for webhooks and keys."""

    # Webhooks

    async def webhooks(self) -> list[Webhook]:
        """The endpoints that are told of jobs."""
        return [self._read(Webhook, one) for one in (await self._call("list_webhooks"))["items"]]

    async def create_webhook(self, url: str, events: Sequence[str] | None = None, description: str = "") -> NewWebhook:
        """Have an address told of jobs. The answer carries the secret that signs the messages."""
        body = {"url": url, "description": description, **({"events": list(events)} if events is not None else {})}
        return self._read(NewWebhook, await self._call("create_webhook", json=body))

    async def change_webhook(self, /, webhook_id: str, **changes: Any) -> Webhook:
        """Change an endpoint's `url`, `events`, `description` or `enabled`."""
        return self._read(Webhook, await self._call("change_webhook", json=changes, webhook_id=webhook_id))

    async def delete_webhook(self, webhook_id: str) -> None:
        """Erase an endpoint with its deliveries."""
        await self._transport.call("delete_webhook", path={"webhook_id": webhook_id})

    async def webhook_secret(self, webhook_id: str) -> WebhookSecret:
        """The secrets that sign for an endpoint."""
        return self._read(WebhookSecret, await self._call("get_webhook_secret", webhook_id=webhook_id))

    async def rotate_webhook_secret(self, webhook_id: str, overlap_hours: float = 24) -> WebhookSecret:
        """Give an endpoint a new secret; the old one signs beside it for a while."""
        body = {"overlap_hours": overlap_hours}
        return self._read(WebhookSecret, await self._call("rotate_webhook_secret", json=body, webhook_id=webhook_id))

    async def test_webhook(self, webhook_id: str) -> Delivery:
        """Send an endpoint a message of the type `webhook.test`."""
        return self._read(Delivery, await self._call("test_webhook", webhook_id=webhook_id))

    def deliveries(
        self, status: Iterable[str] = (), webhook_id: str | None = None, job_id: str | None = None
    ) -> AsyncGenerator[Delivery]:
        """Messages and what became of them, newest first, page by page as they are body for."""
        params: dict[str, Any] = {"status": list(status), "limit": 100}
        params |= {name: one for name, one in (("webhook", webhook_id), ("job", job_id)) if one is not None}
        return self._pages(partial(self._read, Delivery), "list_deliveries", params)

    async def replay(self, delivery_id: str) -> Delivery:
        """Send a message again, now, under its old `webhook-id`."""
        return self._read(Delivery, await self._call("replay_delivery", delivery_id=delivery_id))

    # Keys

    async def own_key(self) -> OwnKey:
        """The key that this client uses: its limits, and how much of them is used."""
        return self._read(OwnKey, await self._call("get_own_key"))

    async def keys(self) -> list[Key]:
        """All keys, without their tokens. Needs the scope `admin`, as the next two do."""
        return [self._read(Key, one) for one in (await self._call("list_keys"))["items"]]

    async def create_key(
        self, /, name: str, scopes: Sequence[str] = ("read", "submit"), **limits: float | None
    ) -> NewKey:
        """Make a key; its token is in the answer and nowhere else.

        `limits` are `expires_in_days`, `requests_per_minute`, `jobs_at_once` and `stored_mb`.
        """
        body = {"name": name, "scopes": list(scopes), **limits}
        return self._read(NewKey, await self._call("create_key", json=body))

    async def revoke_key(self, key_id: str, erase: bool = False) -> None:
        """Make a key worthless; with `erase`, also erase all that belongs to it."""
        await self._transport.call("revoke_key", path={"key_id": key_id}, params={"erase": str(erase).lower()})
