"""Public links as the API takes and shows them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Annotated
from urllib.parse import quote

from pydantic import BaseModel, Field

from service.http.request_models import REQUEST_MODEL
from service.tables.artifacts import Artifact
from service.tables.jobs import Job
from service.tables.links import PublicLink


class LinkIn(BaseModel):
    """A link to be made."""

    model_config = REQUEST_MODEL

    expires_in_hours: float | None = Field(None, gt=0, le=876_000)
    """Null: it is good until it is revoked. Left out: as long as the service's settings say
    (`GALATEA_PUBLIC_LINK_HOURS`)."""
    artifacts: Annotated[list[str], Field(fail_fast=True, min_length=1, max_length=200)] | None = None
    """The artifacts that it opens; null: all of them."""


class LinkOut(BaseModel):
    """A public link, as its owner sees it."""

    id: str
    owner: str
    """The id of the key that made it."""
    job_id: str
    url: str | None
    """What it opens, as JSON; the artifacts lie below it. It is in the answer that made the link and nowhere else: null
    ever after."""
    page: str | None
    """What it opens, as a page for people; null where `url` is."""
    hint: str
    """The first characters of what is secret in the address."""
    artifacts: list[str] | None
    created_at: datetime
    expires_at: datetime | None

    @classmethod
    def of(cls, link: PublicLink, token: str | None = None) -> LinkOut:
        return cls(
            id=link.id,
            owner=link.owner,
            job_id=link.job_id,
            url=None if token is None else _address(token),
            page=None if token is None else f"/#/shared/{token}",
            hint=link.hint,
            artifacts=link.names,
            created_at=link.created_at,
            expires_at=link.expires_at,
        )


class LinkList(BaseModel):
    """A job's public links, oldest first."""

    items: list[LinkOut]


class LinkPage(BaseModel):
    """Public links, newest first."""

    items: list[LinkOut]
    next_cursor: str | None
    """Give it as `cursor` to get the next page; null on the last one."""


class SharedArtifactOut(BaseModel):
    """An artifact that a public link opens."""

    url: str
    size: int
    sha256: str
    content_type: str


class SharedOut(BaseModel):
    """What a public link opens."""

    kind: str
    title: str | None
    """What its owner calls it; null where they gave it no title. Nothing else that the job was given is told."""
    has_sound: bool | None
    """Whether sound was asked for by the option `sound`; null where nothing was said of it."""
    finished_at: datetime | None
    expires_at: datetime | None
    artifacts: dict[str, SharedArtifactOut]

    @classmethod
    def of(cls, link: PublicLink, token: str, job: Job, artifacts: Sequence[Artifact]) -> SharedOut:
        shared = {
            artifact.name: SharedArtifactOut(
                url=f"{_address(token)}/{quote(artifact.name)}",
                size=artifact.size,
                sha256=artifact.sha256,
                content_type=artifact.content_type,
            )
            for artifact in artifacts
            if opens_artifact(link, artifact.name)
        }
        return cls(
            kind=job.kind,
            title=job.title,
            has_sound=sound if isinstance(sound := job.options.get("sound"), bool) else None,
            finished_at=job.finished_at,
            expires_at=link.expires_at,
            artifacts=shared,
        )


def opens_artifact(link: PublicLink, name: str) -> bool:
    """Whether a link opens the artifact of this name."""
    return link.names is None or name in link.names


def _address(token: str) -> str:
    return f"/v1/public/{token}"
