"""When a delivery that failed is tried again, and when an endpoint that fails is disabled.

The steps are those that the Standard Webhooks specification suggests: ten attempts over a little more than three
days. A little chance is added, so that what failed together does not come back together.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from random import Random

from service.tables.webhooks import EventType, Webhook

RETRY_DELAYS = (
    timedelta(seconds=5),
    timedelta(minutes=5),
    timedelta(minutes=30),
    timedelta(hours=2),
    timedelta(hours=5),
    timedelta(hours=10),
    timedelta(hours=14),
    timedelta(hours=20),
    timedelta(hours=24),
)
JITTER_SHARE = 0.1
MAX_PAUSE = RETRY_DELAYS[-1] * (1 + JITTER_SHARE)

PROGRESS_RETRIES = 2
"""Progress is not worth telling hours later: the job has ended by then, and that is told by itself."""

FAILING_DAYS = 5
"""Days without a successful attempt after which an endpoint is disabled."""
FAILING_DELIVERIES = 3
"""Deliveries that have to be given up within `FAILING_DAYS` for an endpoint to be disabled."""


def retry_delay(event: str, tries: int, retry_after: timedelta | None, chance: Random) -> timedelta | None:
    """How long to wait after an attempt that was the `tries`-th to fail (from 1); None if it was the last.

    `retry_after` is what the receiver asked for: it may make the pause longer, up to a day.
    """
    retries = RETRY_DELAYS[:PROGRESS_RETRIES] if event == EventType.PROGRESS else RETRY_DELAYS
    if tries > len(retries):
        return None
    planned = retries[tries - 1] * (1 + JITTER_SHARE * chance.random())
    return planned if retry_after is None else max(planned, min(retry_after, RETRY_DELAYS[-1]))


def is_lost(webhook: Webhook, moment: datetime) -> bool:
    """Whether an endpoint has failed for so long that it is to be disabled: no attempt succeeded for five days, and
    three deliveries in that time were given up."""
    if webhook.failing_since is None or webhook.given_up < FAILING_DELIVERIES:
        return False
    return moment - webhook.failing_since >= timedelta(days=FAILING_DAYS)
