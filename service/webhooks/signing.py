"""Secrets and signatures by the Standard Webhooks specification (version 1.0.0, symmetric scheme `v1`)."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

import standardwebhooks

from service.tables.webhooks import Webhook


def live_secrets(webhook: Webhook, moment: datetime) -> tuple[str, ...]:
    """The secrets that sign for an endpoint at a moment: the current one first, the previous one until it expires.
    Raises `SecretUnreadable`."""
    if webhook.previous_secret is None or webhook.previous_until is None or webhook.previous_until <= moment:
        return (webhook.secret.reveal(),)
    return webhook.secret.reveal(), webhook.previous_secret.reveal()


def signed_headers(secrets: Sequence[str], message_id: str, moment: datetime, body: str) -> dict[str, str]:
    """The headers of one attempt. Each secret gives one signature; a receiver needs to know one of them."""
    signatures = [standardwebhooks.Webhook(secret).sign(message_id, moment, body) for secret in secrets]
    return {
        "webhook-id": message_id,
        "webhook-timestamp": str(int(moment.timestamp())),
        "webhook-signature": " ".join(signatures),
    }
