"""Jobs and their artifacts as the API and webhooks show them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any, Literal, cast
from urllib.parse import quote

from pydantic import BaseModel, JsonValue

from service.clock import now
from service.job_records.signed_links import Signer
from service.tables.artifacts import Artifact
from service.tables.jobs import Job, Priority, Status

PriorityName = Literal["high", "normal", "low"]


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


class Progress(BaseModel):
    """How far a job is."""

    stage: str | None = None
    fraction: float = 0.0
    message: str = ""
    eta_seconds: float | None = None
    stages: list[str] = []
    """The stages that have begun so far, in the order of the work."""


class JobError(BaseModel):
    """Why a job failed."""

    code: str
    detail: str
    correctable: list[str] = []
    """The corrections that could mend it."""
    found: dict[str, JsonValue] = {}
    """What helps with that: for a portrait the boxes of its `faces` (x, y, width, height in pixels of the picture)."""


class JobOut(BaseModel):
    """A job."""

    id: str
    kind: str
    title: str | None
    """What the work is called: the same in all jobs of a `tree`."""
    status: Status
    priority: PriorityName
    progress: Progress
    queue_position: int | None
    """A number while the job is queued, null otherwise: 1 where it is the next of its kind. Others may still come before
    it: those of a higher priority, and of keys of which fewer jobs run."""
    inputs: dict[str, str | list[str]]
    options: dict[str, JsonValue]
    artifacts: dict[str, ArtifactOut]
    error: JobError | None
    metadata: dict[str, JsonValue]
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    revision_of: str | None
    """The job that this one revises."""
    tree: str
    """The work that this job is a version of: the id of the job that was revised first, or of this one. It stays when
    that job is erased."""

    @classmethod
    def of(
        cls, job: Job, artifacts: Sequence[Artifact], signer: Signer | None = None, queue_position: int | None = None
    ) -> JobOut:
        return cls(
            id=job.id,
            kind=job.kind,
            title=job.title,
            status=Status(job.status),
            priority=cast(PriorityName, Priority(job.priority).name.lower()),
            progress=_progress(job),
            queue_position=queue_position,
            inputs=job.inputs,
            options=job.options,
            artifacts={artifact.name: ArtifactOut.of(artifact, signer) for artifact in artifacts},
            error=JobError.model_validate(job.error) if job.error else None,
            metadata=job.notes,
            created_at=job.created_at,
            started_at=job.started_at,
            finished_at=job.finished_at,
            revision_of=job.revision_of,
            tree=job.tree,
        )


class JobPage(BaseModel):
    """Jobs, newest first."""

    items: list[JobOut]
    versions: dict[str, int]
    """How many jobs there are of each of their works, by `tree`."""
    next_cursor: str | None
    """Give it as `cursor` to get the next page; null on the last one."""


class JobTree(BaseModel):
    """A job and all its revisions, oldest first; `revision_of` says which revises which."""

    items: list[JobOut]


def _progress(job: Job) -> Progress:
    values: dict[str, Any] = dict(job.progress)
    eta = values.get("eta_seconds")
    if job.status != Status.RUNNING:
        values["eta_seconds"] = None
    elif eta is not None and job.progress_at is not None:
        left = round(eta - (now() - job.progress_at).total_seconds(), 1)
        values["eta_seconds"] = left if left > 0 else None  # the estimate was too low: nobody knows
    return Progress.model_validate(values)
