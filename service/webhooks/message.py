"""The body of a message: `{type, timestamp, sequence, data}`."""

from __future__ import annotations

import json
from datetime import UTC
from typing import Any

from service.job_records.signed_links import Signer
from service.tables.webhooks import Delivery


def body(delivery: Delivery, signer: Signer, public_url: str | None) -> str:
    """What one attempt sends. Artifacts carry links that are good from this moment on; all links are absolute where
    the service's own address is known."""
    data = dict(delivery.payload)
    if "artifacts" in data:
        data["artifacts"] = {
            name: {
                **shown,
                "url": _absolute(shown["url"], public_url),
                "signed_url": _absolute(signer.link(data["id"], name), public_url),
            }
            for name, shown in data["artifacts"].items()
        }
    document: dict[str, Any] = {"type": delivery.event, "timestamp": _iso(delivery), "sequence": delivery.sequence}
    return json.dumps(document | {"data": data}, separators=(",", ":"))


def _absolute(path: str, public_url: str | None) -> str:
    return (public_url or "") + path


def _iso(delivery: Delivery) -> str:
    return delivery.created_at.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")
