"""Public links as the API takes and shows them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Annotated
from urllib.parse import quote

from pydantic import BaseModel, Field

from service.artifacts.models import Artifact
from service.asked import ASKED
from service.links.models import PublicLink


class LinkIn(BaseModel):
    """A link to be made."""

    model_config = ASKED

    expires_in_hours: float | None = Field(None, gt=0, le=876_000)
    """Null: it is good until it is revoked."""
    artifacts: Annotated[list[str], Field(fail_fast=True, min_length=1, max_length=200)] | None = None
    """The artifacts that it opens; null: all of them."""


class LinkOut(BaseModel):
    """A public link, as its owner sees it."""

    id: str
    url: str
    """What it opens, as JSON; the artifacts lie below it."""
    page: str
    """The same for people."""
    artifacts: list[str] | None
    created_at: datetime
    expires_at: datetime | None

    @classmethod
    def of(cls, link: PublicLink) -> LinkOut:
        return cls(
            id=link.id,
            url=_address(link),
            page=f"/#/shared/{link.token}",
            artifacts=link.names,
            created_at=link.created_at,
            expires_at=link.expires_at,
        )


class LinkList(BaseModel):
    """A job's public links, oldest first."""

    items: list[LinkOut]


class SharedArtifactOut(BaseModel):
    """An artifact that a public link opens."""

    url: str
    size: int
    sha256: str
    content_type: str


class SharedOut(BaseModel):
    """What a public link opens."""

    kind: str
    finished_at: datetime | None
    expires_at: datetime | None
    artifacts: dict[str, SharedArtifactOut]

    @classmethod
    def of(cls, link: PublicLink, kind: str, finished_at: datetime | None, artifacts: Sequence[Artifact]) -> SharedOut:
        shared = {
            artifact.name: SharedArtifactOut(
                url=f"{_address(link)}/{quote(artifact.name)}",
                size=artifact.size,
                sha256=artifact.sha256,
                content_type=artifact.content_type,
            )
            for artifact in artifacts
            if opens(link, artifact.name)
        }
        return cls(kind=kind, finished_at=finished_at, expires_at=link.expires_at, artifacts=shared)


def opens(link: PublicLink, name: str) -> bool:
    """Whether a link opens the artifact of this name."""
    return link.names is None or name in link.names


def _address(link: PublicLink) -> str:
    return f"/v1/public/{link.token}"
