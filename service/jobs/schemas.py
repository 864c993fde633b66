"""Jobs as the API takes and shows them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, JsonValue

from service.artifacts.models import Artifact
from service.artifacts.schemas import ArtifactOut
from service.clock import now
from service.jobs.models import Job, Status


class JobIn(BaseModel):
    """What a client asks for."""

    model_config = ConfigDict(extra="forbid")

    kind: str
    inputs: dict[str, str | list[str]] = {}
    """Input names to file ids or names of drivers; a list where an input takes many."""
    options: dict[str, JsonValue] = {}
    webhook_url: str | None = None
    metadata: dict[str, JsonValue] = Field({}, max_length=100)


class Progress(BaseModel):
    """How far a job is."""

    stage: str | None = None
    fraction: float = 0.0
    message: str = ""
    eta_seconds: float | None = None


class JobError(BaseModel):
    """Why a job failed."""

    code: str
    detail: str
    correctable: list[str] = []
    """The corrections that could mend it."""


class JobOut(BaseModel):
    """A job."""

    id: str
    kind: str
    status: Status
    progress: Progress
    inputs: dict[str, str | list[str]]
    options: dict[str, JsonValue]
    artifacts: dict[str, ArtifactOut]
    error: JobError | None
    metadata: dict[str, JsonValue]
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None

    @classmethod
    def of(cls, job: Job, artifacts: Sequence[Artifact]) -> JobOut:
        return cls(
            id=job.id,
            kind=job.kind,
            status=Status(job.status),
            progress=_progress(job),
            inputs=job.inputs,
            options=job.options,
            artifacts={artifact.name: ArtifactOut.of(artifact) for artifact in artifacts},
            error=JobError.model_validate(job.error) if job.error else None,
            metadata=job.notes,
            created_at=job.created_at,
            started_at=job.started_at,
            finished_at=job.finished_at,
        )


class JobPage(BaseModel):
    """Jobs, newest first."""

    items: list[JobOut]
    next_cursor: str | None
    """Give it as `cursor` to get the next page; null on the last one."""


def _progress(job: Job) -> Progress:
    values: dict[str, Any] = dict(job.progress)
    eta = values.get("eta_seconds")
    if job.status != Status.RUNNING:
        values["eta_seconds"] = None
    elif eta is not None and job.progress_at is not None:
        left = round(eta - (now() - job.progress_at).total_seconds(), 1)
        values["eta_seconds"] = left if left > 0 else None  # the estimate was too low: nobody knows
    return Progress.model_validate(values)
