"""Artifacts as the API shows them."""

from __future__ import annotations

from urllib.parse import quote

from pydantic import BaseModel

from service.artifacts.links import Signer
from service.tables.artifacts import Artifact


class ArtifactOut(BaseModel):
    """A published artifact."""

    url: str
    """For callers with a key."""
    signed_url: str | None = None
    """For whoever has this address, until it expires."""
    size: int
    sha256: str
    content_type: str

    @classmethod
    def of(cls, artifact: Artifact, signer: Signer | None = None) -> ArtifactOut:
        return cls(
            url=f"/v1/jobs/{artifact.job_id}/artifacts/{quote(artifact.name)}",
            signed_url=signer.link(artifact.job_id, artifact.name) if signer else None,
            size=artifact.size,
            sha256=artifact.sha256,
            content_type=artifact.content_type,
        )
