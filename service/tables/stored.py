"""What a row says of its file in the storage: all that is needed to send it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True)
class Stored:
    """Something that can be sent."""

    key: str
    name: str
    content_type: str
    size: int
    sha256: str
    modified: datetime
