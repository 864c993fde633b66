"""A job: what is known of it, and what can be done with it."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Generator, Mapping
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from pydantic import PrivateAttr

from galatea_client.events import Event
from galatea_client.models import Artifact, JobError, Link, Model, Progress, Status
from galatea_client.transfer import OnProgress

if TYPE_CHECKING:
    from galatea_client.async_client import AsyncClient
    from galatea_client.client import Client


class JobDocument(Model):
    """A job as it was when the service was asked."""

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

    _client: Any = PrivateAttr(None)

    def bound(self, client: Any) -> Self:
        """The job, with the client that its methods use."""
        self._client = client
        return self

    def _bound_to(self) -> Any:
        if self._client is None:
            raise ValueError("the job did not come by a client")
        return self._client


class Job(JobDocument):
    """A job as it was when the service was asked; every method that changes it or waits returns it anew."""

    @property
    def client(self) -> Client:
        """The client that the job came by."""
        client: Client = self._bound_to()
        return client

    def refresh(self) -> Job:
        """The job as it is now."""
        return self.client.job(self.id)

    def follow(self, after: int = 0) -> Generator[Event]:
        """What happens to the job, as it happens, from the beginning or after an event; ends with the job."""
        return self.client.follow(self.id, after)

    def wait(self, seconds: float | None = None, progress: Callable[[Progress], None] | None = None) -> Job:
        """The job when it has ended well. Raises `JobFailed` if it ended otherwise, `TimeoutError` after `seconds`."""
        return self.client.wait(self.id, seconds, progress)

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


class AsyncJob(JobDocument):
    """A job by an `AsyncClient`: its methods are awaited, its events come by `async for`."""

    @property
    def client(self) -> AsyncClient:
        """The client that the job came by."""
        client: AsyncClient = self._bound_to()
        return client

    async def refresh(self) -> AsyncJob:
        """The job as it is now."""
        return await self.client.job(self.id)

    def follow(self, after: int = 0) -> AsyncGenerator[Event]:
        """What happens to the job, as it happens, from the beginning or after an event; ends with the job."""
        return self.client.follow(self.id, after)

    async def wait(self, seconds: float | None = None, progress: Callable[[Progress], None] | None = None) -> AsyncJob:
        """The job when it has ended well. Raises `JobFailed` if it ended otherwise, `TimeoutError` after `seconds`."""
        return await self.client.wait(self.id, seconds, progress)

    async def download(self, name: str, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an artifact into a folder or to a file; returns the file, whose checksum was compared."""
        return await self.client.download(self, name, to, progress)

    async def download_all(self, folder: str | Path, progress: OnProgress | None = None) -> list[Path]:
        """Fetch every artifact into a folder."""
        return [await self.download(name, folder, progress) for name in self.artifacts]

    async def cancel(self) -> AsyncJob:
        """Cancel the job."""
        return await self.client.cancel(self.id)

    async def delete(self) -> None:
        """Erase the job with its media."""
        await self.client.delete(self.id)

    async def revise(
        self, corrections: Mapping[str, Any] | None = None, options: Mapping[str, Any] | None = None, **submission: Any
    ) -> AsyncJob:
        """The job again with something different (see `AsyncClient.revise`)."""
        return await self.client.revise(self.id, corrections, options, **submission)

    async def revisions(self) -> list[AsyncJob]:
        """The job, what it revises, and all that revises it, oldest first."""
        return await self.client.revisions(self.id)

    async def link(
        self, expires_in_hours: float | None = None, artifacts: list[str] | None = None, lasting: bool = False
    ) -> Link:
        """Make its results public under an address that cannot be guessed (see `AsyncClient.create_link`)."""
        return await self.client.create_link(self.id, expires_in_hours, artifacts, lasting)
