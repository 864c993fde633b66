"""The table of keys: who may do what, and how much of it."""

from __future__ import annotations

from datetime import datetime

from sqlalchemy import JSON, String
from sqlalchemy.orm import Mapped, mapped_column

from service.tables.base import Base, Sealed, UTCDateTime
from service.vault import Secret

LOCAL_KEY_ID = "local"
"""The id of the one key without a token: it stands for callers on this machine where no key is needed."""


class Key(Base):
    """A key. Everything that is uploaded or made belongs to one."""

    __tablename__ = "keys"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    name: Mapped[str] = mapped_column(String(100))
    token_hash: Mapped[str | None] = mapped_column(String(64), unique=True)
    """SHA-256 of the token, which is 256 random bits and kept nowhere; null for the local key and revoked ones."""
    hint: Mapped[str] = mapped_column(String(16))
    """The token's first characters, to tell keys apart."""
    scopes: Mapped[list[str]] = mapped_column(JSON)
    signing_secret: Mapped[Secret] = mapped_column(Sealed)
    """Signs the webhooks that jobs name themselves; shown to the key's owner."""
    link_secret: Mapped[Secret] = mapped_column(Sealed)
    """Signs links and sessions; shown to nobody."""
    requests_per_minute: Mapped[int | None]
    jobs_at_once: Mapped[int | None]
    stored_mb: Mapped[int | None]
    created_at: Mapped[datetime] = mapped_column(UTCDateTime)
    expires_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    revoked_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
    last_used_at: Mapped[datetime | None] = mapped_column(UTCDateTime)
