"""Artifacts as the API shows them."""

from __future__ import annotations

from urllib.parse import quote

from pydantic import BaseModel

from service.artifacts.models import Artifact


class ArtifactOut(BaseModel):
    """A published artifact."""

    url: str
    size: int
    sha256: str
    content_type: str

    @classmethod
    def of(cls, artifact: Artifact) -> ArtifactOut:
        return cls(
            url=f"/v1/jobs/{artifact.job_id}/artifacts/{quote(artifact.name)}",
            size=artifact.size,
            sha256=artifact.sha256,
            content_type=artifact.content_type,
        )
