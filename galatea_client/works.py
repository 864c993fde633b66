"""Works: files that are uploaded, jobs that are made of them, what comes of these, and links that show it to others."""

from __future__ import annotations

import os
import time
import uuid
from collections.abc import AsyncGenerator, Callable, Iterable, Mapping, Sequence
from contextlib import aclosing
from datetime import datetime
from functools import partial
from math import inf
from pathlib import Path
from typing import Any, BinaryIO, Literal

from galatea_client.errors import JobFailed, NotAName
from galatea_client.events import Event, ProgressEvent, follow
from galatea_client.job import JobDocument
from galatea_client.models import File, Link, Progress, Status
from galatea_client.requests import J, Requests
from galatea_client.transfer import OnProgress, Upload, fetch, send_file, target_file

Source = str | Path | bytes | bytearray | BinaryIO
"""A file of this machine (a `Path`), what it holds, an open one; or the id of an uploaded one or the name of a driver or a
motion (a text)."""


class Works(Requests[J]):
    """The methods for files, jobs and public links."""

    # Files

    async def upload(self, source: Upload, progress: OnProgress | None = None) -> File:
        """Upload a picture or video, given as a path, bytes or an open file; `progress` is called with the bytes sent and all bytes."""
        return self._read(File, (await send_file(self._transport, "create_file", source, progress)).json())

    async def file(self, file_id: str) -> File:
        """What is known of an uploaded file."""
        return self._read(File, await self._call("get_file", file_id=file_id))

    async def download_file(self, file: File, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an uploaded file into a folder or to a file."""
        target = target_file(to, file.name)
        path = {"file_id": file.id}
        return await fetch(self._transport, "get_file_content", path, target, file.size, file.sha256, progress)

    # Jobs

    async def submit(
        self,
        kind: str,
        inputs: Mapping[str, Source | Sequence[Source]],
        options: Mapping[str, Any] | None = None,
        metadata: Mapping[str, Any] | None = None,
        wait: float | None = None,
        idempotency_key: str | None = None,
        priority: Literal["high", "normal", "low"] = "normal",
        webhook_url: str | None = None,
        webhook_events: Sequence[str] | None = None,
        title: str | None = None,
    ) -> J:
        """Submit a job.

        Parameters
        ----------
        kind : such as "portrait"; `kinds` lists them.
        inputs : by name. A `Path` is uploaded; a text is the id of an uploaded file, or the name of a driver or a
                motion.
        options : those of the kind.
        metadata : the caller's own, comes back with the job.
        wait : seconds that the answer may be held back until the job has ended.
        idempotency_key : the same key with the same request makes one job; a fresh one by default, so that sending
            again after a broken line is safe.
        priority : waiting jobs of a kind are taken in this order; "high" takes a key with the scope `admin`.
        webhook_url, webhook_events : an address that is told of this job, and of what; of its end alone by default.
        title : what the work is called.

        Raises `ApiError`; a job that fails is told by `Job.wait`.
        """
        body: dict[str, Any] = {
            "kind": kind,
            "inputs": {name: await self._source(value) for name, value in inputs.items()},
            "options": dict(options or {}),
            "metadata": dict(metadata or {}),
            "priority": priority,
            "webhook_url": webhook_url,
            "webhook_events": None if webhook_events is None else list(webhook_events),
        }
        if title is not None:
            body["title"] = title
        return await self._submit("create_job", {}, body, wait, idempotency_key)

    async def revise(
        self,
        job_id: str,
        corrections: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        metadata: Mapping[str, Any] | None = None,
        wait: float | None = None,
        idempotency_key: str | None = None,
    ) -> J:
        """Submit an ended job again with corrections or other options: only what depends on them is worked out anew.

        A correction that is a file (the `mask` of a character, say) is given like an input: a `Path` is uploaded. None
        takes a correction back, and an option to its default. The rest is as for `submit`.
        """
        given = {
            name: await self._source(v) if isinstance(v, Path | bytes | bytearray) or hasattr(v, "read") else v
            for name, v in (corrections or {}).items()
        }
        body: dict[str, Any] = {"corrections": given, "options": dict(options or {})}
        if metadata is not None:
            body["metadata"] = dict(metadata)
        return await self._submit("revise_job", {"job_id": job_id}, body, wait, idempotency_key)

    async def job(self, job_id: str) -> J:
        """A job."""
        return self._job(await self._call("get_job", job_id=job_id))

    def jobs(
        self,
        status: Iterable[Status | str] = (),
        kind: Iterable[str] = (),
        created_after: datetime | None = None,
        created_before: datetime | None = None,
        q: str = "",
        latest: bool = False,
    ) -> AsyncGenerator[J]:
        """Jobs, newest first, page by page as they are params for. `q` are words of title, kind, and the names of
        files, drivers and motions. With `latest` there is of each work the newest of its versions alone."""
        params: dict[str, Any] = {"status": [str(one) for one in status], "kind": list(kind), "limit": 100}
        for name, moment in (("created_after", created_after), ("created_before", created_before)):
            if moment is not None:
                params[name] = moment.astimezone().isoformat()
        if q:
            params["q"] = q
        if latest:
            params["latest"] = True
        return self._pages(self._job, "list_jobs", params)

    def follow(self, job_id: str, after: int = 0) -> AsyncGenerator[Event]:
        """What happens to a job, as it happens; a broken line is taken up again. Ends with the job."""
        return follow(self._transport, job_id, after)

    async def wait(
        self, job_id: str, seconds: float | None = None, progress: Callable[[Progress], None] | None = None
    ) -> J:
        """A job when it has ended well. Raises `JobFailed` if it ended otherwise, `TimeoutError` after `seconds`."""
        deadline = inf if seconds is None else time.monotonic() + seconds
        async with aclosing(follow(self._transport, job_id, deadline=deadline)) as events:
            async for event in events:
                if progress is not None and isinstance(event, ProgressEvent):
                    progress(event.progress)
        job = await self.job(job_id)
        if job.status is not Status.SUCCEEDED:
            raise JobFailed(job)
        return job

    async def rename(self, job_id: str, title: str | None) -> J:
        """Give the work that a job is a version of a title, or take it away."""
        return self._job(await self._call("change_job", json={"title": title}, job_id=job_id))

    async def cancel(self, job_id: str) -> J:
        """Cancel a job. Raises `Conflict` if it has ended otherwise."""
        return self._job(await self._call("cancel_job", again=True, job_id=job_id))

    async def delete(self, job_id: str) -> None:
        """Erase a job with its media."""
        await self._transport.call("delete_job", path={"job_id": job_id})

    async def revisions(self, job_id: str) -> list[J]:
        """A job, what it revises, and all that revises it, oldest first."""
        return [self._job(one) for one in (await self._call("list_revisions", job_id=job_id))["items"]]

    async def download(
        self, job: JobDocument, name: str, to: str | Path = ".", progress: OnProgress | None = None
    ) -> Path:
        """Fetch an artifact into a folder or to a file. What an earlier attempt left is taken up.

        Raises `KeyError` if the job has none of this name, `DownloadBroken` if other bytes arrive than were announced.
        """
        artifact = job.artifacts[name]
        path = {"job_id": job.id, "name": name}
        return await fetch(
            self._transport, "get_artifact", path, target_file(to, name), artifact.size, artifact.sha256, progress
        )

    async def download_archive(self, job_id: str, to: str | Path = ".") -> Path:
        """Fetch all artifacts of an ended job as one zip."""
        target = target_file(to, f"{job_id}.zip")
        draft = target.with_name(target.name + ".part")
        line = self._transport.line
        async with self._transport.stream("get_archive", path={"job_id": job_id}) as response:
            with draft.open("wb") as file:
                async for piece in line.pieces(response):
                    await line.aside(file.write, piece)
        return draft.replace(target)

    # Public links

    async def create_link(
        self,
        job_id: str,
        expires_in_hours: float | None = None,
        artifacts: list[str] | None = None,
        lasting: bool = False,
    ) -> Link:
        """Make a job's results public under an address that cannot be guessed, which only this answer tells.

        It is good for `expires_in_hours`, or where `lasting` until it is revoked; for as long as the service's settings
        say by default.
        """
        body: dict[str, Any] = {"artifacts": artifacts}
        if lasting or expires_in_hours is not None:
            body["expires_in_hours"] = None if lasting else expires_in_hours
        return self._read(Link, await self._call("create_link", json=body, job_id=job_id))

    async def links(self, job_id: str) -> list[Link]:
        """The public links to a job."""
        return [self._read(Link, one) for one in (await self._call("list_links", job_id=job_id))["items"]]

    def all_links(self) -> AsyncGenerator[Link]:
        """The public links to all jobs, newest first: one's own, or with the scope `admin` those of every key."""
        return self._pages(partial(self._read, Link), "list_all_links", {"limit": 100})

    async def revoke_link(self, link_id: str) -> None:
        """Take a public link back."""
        await self._transport.call("revoke_link", path={"link_id": link_id})

    async def _submit(
        self, operation: str, path: dict[str, str], body: dict[str, Any], wait: float | None, key: str | None
    ) -> J:
        headers = {"Idempotency-Key": key or str(uuid.uuid4())}
        timeout = self._timeout
        if wait is not None:
            headers["Prefer"] = f"wait={round(wait)}"
            timeout += wait
        answer = await self._transport.call(operation, True, path=path, json=body, headers=headers, timeout=timeout)
        return self._job(answer.json())

    async def _source(self, value: Source | Sequence[Source]) -> str | list[str]:
        if isinstance(value, str):
            _check_name(value)
            return value
        if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray):
            return [str(await self._source(one)) for one in value]
        return (await self.upload(value)).id


def _check_name(given: str) -> None:
    """Raise `NotAName` where a text that stands for an id or a name is the path of a file."""
    if (os.sep in given or Path(given).suffix) and "://" not in given and Path(given).is_file():
        raise NotAName(f"{given!r} is a file of this machine: give Path({given!r}) to have it uploaded")
