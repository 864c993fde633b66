"""A job: what is known of it, and what can be done with it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import PrivateAttr

from galatea_client.errors import JobFailed
from galatea_client.events import Event, ProgressEvent
from galatea_client.models import Artifact, JobError, Link, Model, Progress, Status
from galatea_client.transfer import OnProgress

if TYPE_CHECKING:
    from galatea_client.client import Client


class Job(Model):
    """A job as it was when the service was asked; every method that changes it or waits returns it anew."""

    id: str
    kind: str
    title: str | None = None
    status: Status
    progress: Progress
    queue_position: int | None
    inputs: dict[str, str | list[str]]
    options: dict[str, Any]
    artifacts: dict[str, Artifact]
    error: JobError | None
    metadata: dict[str, Any]
    priority: str
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    revision_of: str | None
    tree: str

    _client: Client | None = PrivateAttr(None)

    def bound(self, client: Client) -> Job:
        """The job, with the client that its methods use."""
        self._client = client
        return self

    @property
    def client(self) -> Client:
        """The client that the job came by."""
        if self._client is None:
            raise ValueError("the job did not come by a client")
        return self._client

    def refresh(self) -> Job:
        """The job as it is now."""
        return self.client.job(self.id)

    def follow(self, after: int = 0) -> Iterator[Event]:
        """What happens to the job, as it happens, from the beginning or after an event; ends with the job."""
        return self.client.follow(self.id, after)

    def wait(self, seconds: float | None = None, progress: Callable[[Progress], None] | None = None) -> Job:
        """The job when it has ended well. Raises `JobFailed` if it ended otherwise, `TimeoutError` after `seconds`."""
        deadline = None if seconds is None else time.monotonic() + seconds
        for event in self.follow():
            if progress is not None and isinstance(event, ProgressEvent):
                progress(event.progress)
            if deadline is not None and time.monotonic() > deadline:
                raise TimeoutError(f"the job {self.id} has not ended within {seconds:g} s")
        job = self.refresh()
        if job.status is not Status.SUCCEEDED:
            raise JobFailed(job)
        return job

    def download(self, name: str, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an artifact into a folder or to a file; returns the file, whose checksum was compared."""
        return self.client.download(self, name, to, progress)

    def download_all(self, folder: str | Path, progress: OnProgress | None = None) -> list[Path]:
        """Fetch every artifact into a folder."""
        return [self.download(name, folder, progress) for name in self.artifacts]

    def cancel(self) -> Job:
        """Cancel the job."""
        return self.client.cancel(self.id)

    def delete(self) -> None:
        """Erase the job with its media."""
        self.client.delete(self.id)

    def revise(
        self, corrections: Mapping[str, Any] | None = None, options: Mapping[str, Any] | None = None, **submission: Any
    ) -> Job:
        """The job again with something different (see `Client.revise`)."""
        return self.client.revise(self.id, corrections, options, **submission)

    def revisions(self) -> list[Job]:
        """The job, what it revises, and all that revises it, oldest first."""
        return self.client.revisions(self.id)

    def link(
        self, expires_in_hours: float | None = None, artifacts: list[str] | None = None, lasting: bool = False
    ) -> Link:
        """Make its results public under an address that cannot be guessed (see `Client.create_link`)."""
        return self.client.create_link(self.id, expires_in_hours, artifacts, lasting)
