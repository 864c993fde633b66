"""Keys as the API takes and shows them."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated

from pydantic import AfterValidator, BaseModel, Field

from service.auth.caller import SCOPE_MEANINGS, Scope
from service.auth.quotas import Limits
from service.http.request_models import REQUEST_MODEL, WHOLE_NUMBER
from service.settings import Settings
from service.tables.keys import Key


def _each_once(scopes: list[Scope]) -> list[Scope]:
    return [scope for scope in SCOPE_MEANINGS if scope in scopes]


class KeyIn(BaseModel):
    """A key to be made. Limits that are left out are those of the service's settings."""

    model_config = REQUEST_MODEL

    name: str = Field(min_length=1, max_length=100, pattern=r"^[^\x00-\x1f\x7f]+$")
    scopes: Annotated[list[Scope], Field(fail_fast=True, min_length=1, max_length=10), AfterValidator(_each_once)] = [
        "read",
        "submit",
    ]
    expires_in_days: float | None = Field(None, gt=0, le=36_500)
    requests_per_minute: Annotated[int, Field(ge=1, le=1_000_000), WHOLE_NUMBER] | None = None
    jobs_at_once: Annotated[int, Field(ge=0, le=1_000_000), WHOLE_NUMBER] | None = None
    stored_mb: Annotated[int, Field(ge=0, le=1_000_000_000), WHOLE_NUMBER] | None = None


class KeyOut(BaseModel):
    """A key, as it may be seen by whoever manages keys."""

    id: str
    name: str
    hint: str
    """The first characters of its token."""
    scopes: list[str]
    requests_per_minute: float | None
    jobs_at_once: int | None
    stored_mb: int | None
    created_at: datetime
    expires_at: datetime | None
    revoked_at: datetime | None
    last_used_at: datetime | None

    @classmethod
    def of(cls, key: Key) -> KeyOut:
        return cls.model_validate(key, from_attributes=True)


class NewKeyOut(KeyOut):
    """A key that was just made. The token is shown this once."""

    token: str


class KeyList(BaseModel):
    """All keys, oldest first."""

    items: list[KeyOut]


class OwnKeyOut(BaseModel):
    """What a caller may know of the key that it uses."""

    id: str
    name: str
    scopes: list[str]
    signing_secret: str | None
    """Verifies the webhooks of jobs that name a `webhook_url` themselves; only shown to keys that may submit."""
    requests_per_minute: float | None
    jobs_at_once: int | None
    stored_mb: int | None
    expires_at: datetime | None
    jobs_under_way: int
    stored_bytes: int

    @classmethod
    def of(cls, key: Key, settings: Settings, jobs: int, stored: int) -> OwnKeyOut:
        limits = Limits(key, settings)
        return cls(
            id=key.id,
            name=key.name,
            scopes=key.scopes,
            signing_secret=key.signing_secret.reveal() if "submit" in key.scopes else None,
            requests_per_minute=limits.requests_per_minute,
            jobs_at_once=limits.jobs_at_once,
            stored_mb=limits.stored_mb,
            expires_at=key.expires_at,
            jobs_under_way=jobs,
            stored_bytes=stored,
        )


class SessionIn(BaseModel):
    """The key that a session of the web page stands for."""

    model_config = REQUEST_MODEL

    key: str = Field(min_length=1, max_length=200)
