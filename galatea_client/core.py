"""What both clients do, each thing once: its request, and how the answer is read. Lines (`lines`) do the waiting."""

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
from typing import Any, BinaryIO, Generic, Literal, TypeVar

import httpx

from galatea_client.errors import InvalidAddress, JobFailed, NotAName
from galatea_client.events import Event, ProgressEvent, follow
from galatea_client.job import JobDocument
from galatea_client.models import (
    Delivery,
    Driver,
    File,
    Key,
    Kind,
    Link,
    Model,
    Motion,
    NewKey,
    NewWebhook,
    OwnKey,
    Progress,
    Status,
    Webhook,
    WebhookSecret,
)
from galatea_client.transfer import OnProgress, Upload, fetch, send_file
from galatea_client.transport import Transport

Source = str | Path | bytes | bytearray | BinaryIO
"""A file of this machine (a `Path`), what it holds, an open one; or the id of an uploaded one or the name of a driver or a
motion (a text)."""

J = TypeVar("J", bound=JobDocument)
M = TypeVar("M", bound=Model)
T = TypeVar("T")


class Core(Generic[J]):
    """The methods of both clients, by a transport whose line waits as theirs does; `job_type` is what a job is read as."""

    def __init__(self, transport: Transport, timeout: float, job_type: type[J], owner: Any = None):
        """`owner` is the client that jobs are bound to, this by default."""
        self._transport = transport
        self._timeout = timeout
        self._job_type = job_type
        self._owner = owner or self

    async def close(self) -> None:
        """Close the connections."""
        await self._transport.line.close()

    # Files

    async def upload(self, source: Upload, progress: OnProgress | None = None) -> File:
        """Upload a picture or video, given as a path, bytes or an open file; `progress` is called with the bytes sent and all bytes."""
        return self._read(File, (await send_file(self._transport, "create_file", source, progress)).json())

    async def file(self, file_id: str) -> File:
        """What is known of an uploaded file."""
        return self._read(File, await self._call("get_file", file_id=file_id))

    async def download_file(self, file: File, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an uploaded file into a folder or to a file."""
        target = _target(to, file.name)
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
        """Jobs, newest first, page by page as they are asked for; `q` are words of title, kind, and the names of files,
        drivers and motions; with `latest`, of each work the newest of its versions alone."""
        asked: dict[str, Any] = {"status": [str(one) for one in status], "kind": list(kind), "limit": 100}
        for name, moment in (("created_after", created_after), ("created_before", created_before)):
            if moment is not None:
                asked[name] = moment.astimezone().isoformat()
        if q:
            asked["q"] = q
        if latest:
            asked["latest"] = True
        return self._pages(self._job, "list_jobs", asked)

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
            self._transport, "get_artifact", path, _target(to, name), artifact.size, artifact.sha256, progress
        )

    async def download_archive(self, job_id: str, to: str | Path = ".") -> Path:
        """Fetch all artifacts of an ended job as one zip."""
        target = _target(to, f"{job_id}.zip")
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
        asked: dict[str, Any] = {"artifacts": artifacts}
        if lasting or expires_in_hours is not None:
            asked["expires_in_hours"] = None if lasting else expires_in_hours
        return self._read(Link, await self._call("create_link", json=asked, job_id=job_id))

    async def links(self, job_id: str) -> list[Link]:
        """The public links to a job."""
        return [self._read(Link, one) for one in (await self._call("list_links", job_id=job_id))["items"]]

    def all_links(self) -> AsyncGenerator[Link]:
        """The public links to all jobs, newest first: one's own, or with the scope `admin` those of every key."""
        return self._pages(partial(self._read, Link), "list_all_links", {"limit": 100})

    async def revoke_link(self, link_id: str) -> None:
        """Take a public link back."""
        await self._transport.call("revoke_link", path={"link_id": link_id})

    # Kinds and drivers

    async def kinds(self) -> list[Kind]:
        """The job kinds, with the JSON schemas of their inputs and options."""
        return [self._read(Kind, one) for one in (await self._call("list_kinds"))["items"]]

    async def drivers(self) -> list[Driver]:
        """The built-in performances, then one's own driving videos."""
        return [self._read(Driver, one) for one in (await self._call("list_drivers"))["items"]]

    async def driver(self, name: str) -> Driver:
        """A driver; once its `moments_status` is `ready`, with the portions that hold emotions."""
        return self._read(Driver, await self._call("get_driver", name=name))

    async def search_driver(self, name: str) -> Driver:
        """Search one of one's own drivers for moments again."""
        return self._read(Driver, await self._call("search_driver", name=name))

    async def create_driver(self, name: str, source: Upload, progress: OnProgress | None = None) -> Driver:
        """Keep a driving video under a name. It is searched for moments then: see `driver`."""
        answer = await send_file(self._transport, "create_driver", source, progress, {"name": name})
        return self._read(Driver, answer.json())

    async def rename_driver(self, name: str, new: str) -> Driver:
        """Give one of one's own drivers another name. Raises `Conflict` where there is one of that name."""
        return self._read(Driver, await self._call("rename_driver", json={"name": new}, name=name))

    async def delete_driver(self, name: str) -> None:
        """Erase one of one's own drivers."""
        await self._transport.call("delete_driver", path={"name": name})

    # Motions

    async def motions(self) -> list[Motion]:
        """The built-in motions, then one's own."""
        return [self._read(Motion, one) for one in (await self._call("list_motions"))["items"]]

    async def motion(self, name: str) -> Motion:
        """A motion; once its `check_status` is `ready`, with its skeleton and which of its joints moves which."""
        return self._read(Motion, await self._call("get_motion", name=name))

    async def create_motion(self, name: str, source: Source, progress: OnProgress | None = None) -> Motion:
        """Keep a BVH or GLB file under a name: a `Path`, or the id of an uploaded file. It is checked then: see
        `motion`."""
        if not isinstance(source, str):
            answer = await send_file(self._transport, "create_motion", source, progress, {"name": name})
            return self._read(Motion, answer.json())
        return self._read(Motion, await self._call("create_motion", json={"name": name, "file": source}))

    async def check_motion(self, name: str) -> Motion:
        """Check one of one's own motions again."""
        return self._read(Motion, await self._call("check_motion", name=name))

    async def rename_motion(self, name: str, new: str) -> Motion:
        """Give one of one's own motions another name. Raises `Conflict` where there is one of that name."""
        return self._read(Motion, await self._call("rename_motion", json={"name": new}, name=name))

    async def delete_motion(self, name: str) -> None:
        """Erase one of one's own motions."""
        await self._transport.call("delete_motion", path={"name": name})

    async def download_motion(self, motion: Motion, to: str | Path = ".") -> Path:
        """Fetch the file of one of one's own motions to a file."""
        target = _target(to, motion.name)
        answer = await self._transport.call("get_motion_file", path={"name": motion.name})
        await self._transport.line.aside(target.write_bytes, answer.content)
        return target

    # Webhooks

    async def webhooks(self) -> list[Webhook]:
        """The endpoints that are told of jobs."""
        return [self._read(Webhook, one) for one in (await self._call("list_webhooks"))["items"]]

    async def create_webhook(self, url: str, events: Sequence[str] | None = None, description: str = "") -> NewWebhook:
        """Have an address told of jobs. The answer carries the secret that signs the messages."""
        asked = {"url": url, "description": description, **({"events": list(events)} if events is not None else {})}
        return self._read(NewWebhook, await self._call("create_webhook", json=asked))

    async def change_webhook(self, /, webhook_id: str, **changes: Any) -> Webhook:
        """Change an endpoint's `url`, `events`, `description` or `enabled`."""
        return self._read(Webhook, await self._call("change_webhook", json=changes, webhook_id=webhook_id))

    async def delete_webhook(self, webhook_id: str) -> None:
        """Erase an endpoint with its deliveries."""
        await self._transport.call("delete_webhook", path={"webhook_id": webhook_id})

    async def webhook_secret(self, webhook_id: str) -> WebhookSecret:
        """The secrets that sign for an endpoint."""
        return self._read(WebhookSecret, await self._call("get_webhook_secret", webhook_id=webhook_id))

    async def rotate_webhook_secret(self, webhook_id: str, overlap_hours: float = 24) -> WebhookSecret:
        """Give an endpoint a new secret; the old one signs beside it for a while."""
        asked = {"overlap_hours": overlap_hours}
        return self._read(WebhookSecret, await self._call("rotate_webhook_secret", json=asked, webhook_id=webhook_id))

    async def test_webhook(self, webhook_id: str) -> Delivery:
        """Send an endpoint a message of the type `webhook.test`."""
        return self._read(Delivery, await self._call("test_webhook", webhook_id=webhook_id))

    def deliveries(
        self, status: Iterable[str] = (), webhook_id: str | None = None, job_id: str | None = None
    ) -> AsyncGenerator[Delivery]:
        """Messages and what became of them, newest first, page by page as they are asked for."""
        asked: dict[str, Any] = {"status": list(status), "limit": 100}
        asked |= {name: one for name, one in (("webhook", webhook_id), ("job", job_id)) if one is not None}
        return self._pages(partial(self._read, Delivery), "list_deliveries", asked)

    async def replay(self, delivery_id: str) -> Delivery:
        """Send a message again, now, under its old `webhook-id`."""
        return self._read(Delivery, await self._call("replay_delivery", delivery_id=delivery_id))

    # Keys

    async def own_key(self) -> OwnKey:
        """The key that this client uses: its limits, and how much of them is used."""
        return self._read(OwnKey, await self._call("get_own_key"))

    async def keys(self) -> list[Key]:
        """All keys, without their tokens. Needs the scope `admin`, as the next two do."""
        return [self._read(Key, one) for one in (await self._call("list_keys"))["items"]]

    async def create_key(
        self, /, name: str, scopes: Sequence[str] = ("read", "submit"), **limits: float | None
    ) -> NewKey:
        """Make a key; its token is in the answer and nowhere else.

        `limits` are `expires_in_days`, `requests_per_minute`, `jobs_at_once` and `stored_mb`.
        """
        asked = {"name": name, "scopes": list(scopes), **limits}
        return self._read(NewKey, await self._call("create_key", json=asked))

    async def revoke_key(self, key_id: str, erase: bool = False) -> None:
        """Make a key worthless; with `erase`, also erase all that belongs to it."""
        await self._transport.call("revoke_key", path={"key_id": key_id}, params={"erase": str(erase).lower()})

    async def _pages(self, read: Callable[[Any], T], operation: str, asked: dict[str, Any]) -> AsyncGenerator[T]:
        while True:
            page = (await self._transport.call(operation, params=asked)).json()
            for one in page["items"]:
                yield read(one)
            if page["next_cursor"] is None:
                return
            asked = {**asked, "cursor": page["next_cursor"]}

    async def _call(self, operation: str, again: bool | None = None, json: Any = None, **path: str) -> Any:
        body = {} if json is None else {"json": json}
        return (await self._transport.call(operation, again, path=path, **body)).json()

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

    def _job(self, document: Any) -> J:
        return self._read(self._job_type, document).bound(self._owner)

    def _read(self, model: type[M], document: Any) -> M:
        return model.model_validate(document, context=self._transport.context)


def _target(to: str | Path, name: str) -> Path:
    """The file to write: in the folder, or the one that was named. Missing folders are made."""
    path = Path(to)
    if path.is_dir() or path.suffix == "":
        path.mkdir(parents=True, exist_ok=True)
        return path / Path(name).name
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def headers_of(key: str | None) -> dict[str, str]:
    """The headers of every request."""
    return {"Accept-Encoding": "identity", **({"Authorization": f"Bearer {key}"} if key else {})}


def address_of(given: str) -> httpx.URL:
    """The service's address. Raises `InvalidAddress`."""
    try:
        url = httpx.URL(given.rstrip("/"))
    except (httpx.InvalidURL, AttributeError, TypeError) as error:
        raise InvalidAddress(f"{given!r} is no address: {error}") from error
    if url.scheme not in ("http", "https") or not url.host:
        raise InvalidAddress(f"{given!r} is no address: use one such as http://127.0.0.1:8000")
    return url


def _check_name(given: str) -> None:
    """Raise `NotAName` where a text that stands for an id or a name is the path of a file."""
    if (os.sep in given or Path(given).suffix) and "://" not in given and Path(given).is_file():
        raise NotAName(f"{given!r} is a file of this machine: give Path({given!r}) to have it uploaded")
