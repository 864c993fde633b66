"""Signed links: whoever has one reads one artifact, without a key, until it expires or the key is revoked.

They end with whole steps of time, so that a job that is asked for again and again gives the same addresses for a
while, and a browser's cache is of use.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from urllib.parse import quote

from service.auth.tokens import signature, signed_by
from service.settings import Settings
from service.tables.keys import Key


@dataclass(frozen=True)
class Signer:
    """Signs links for what belongs to one key."""

    secret: str
    seconds: float

    @classmethod
    def of(cls, key: Key, settings: Settings) -> Signer:
        return cls(key.link_secret.reveal(), settings.link_hours * 3600)

    def link(self, job_id: str, name: str) -> str:
        """The address of an artifact, good for at least the time that the settings say, and for half as long again at
        most."""
        step = max(1, round(self.seconds / 2))
        expires = str(math.ceil((time.time() + self.seconds) / step) * step)
        signed = signature(self.secret, "artifact", job_id, name, expires)
        return f"/v1/jobs/{job_id}/artifacts/{quote(name)}?expires={expires}&signature={signed}"


def is_valid(key: Key, job_id: str, name: str, expires: str, given: str) -> bool:
    """Whether a link's expiry lies ahead and its signature is that of the key."""
    if not (expires.isascii() and expires.isdigit() and len(expires) < 12) or int(expires) < time.time():
        return False
    return signed_by(key.link_secret.reveal(), given, "artifact", job_id, name, expires)
