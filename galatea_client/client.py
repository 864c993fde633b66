"""The client: one method for each thing that the API offers."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Literal, Self

import httpx

from galatea_client.errors import InvalidAddress, NotAName
from galatea_client.events import Event, follow
from galatea_client.job import Job
from galatea_client.models import (
    Delivery,
    Driver,
    File,
    Key,
    Kind,
    Link,
    Motion,
    NewKey,
    NewWebhook,
    OwnKey,
    Status,
    Webhook,
    WebhookSecret,
)
from galatea_client.transfer import OnProgress, Upload, fetch, send_file
from galatea_client.transport import Transport

Source = str | Path | bytes | bytearray | BinaryIO
"""A file of this machine (a `Path`), what it holds, an open one; or the id of an uploaded one or the name of a driver or a motion (a text)."""


class Client:
    """A connection to a service; a context manager.

    Parameters
    ----------
    base_url : where the service is, such as "http://127.0.0.1:8000".
    key : what `galatea keys create` printed; none is needed on the service's own machine.
    retries : how often a request is sent again when the line breaks or the service says to come back later.
    patience : the longest that the service may ask to wait before that, seconds.
    timeout : seconds without an answer after which a line counts as broken.
    transport : what httpx sends requests by, such as `httpx.HTTPTransport(verify=...)`; its own by default.

    Raises
    ------
    InvalidAddress : `base_url` is none.
    """

    def __init__(
        self,
        base_url: str,
        key: str | None = None,
        retries: int = 4,
        patience: float = 60.0,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
    ):
        headers = {"Accept-Encoding": "identity", **({"Authorization": f"Bearer {key}"} if key else {})}
        self._http = httpx.Client(base_url=_address(base_url), headers=headers, timeout=timeout, transport=transport)
        self._transport = Transport(self._http, retries, patience)
        self._timeout = timeout

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    # Files

    def upload(self, source: Upload, progress: OnProgress | None = None) -> File:
        """Upload a picture or video, given as a path, bytes or an open file; `progress` is called with the bytes sent and all bytes."""
        return File.model_validate(send_file(self._transport, "create_file", source, progress).json())

    def file(self, file_id: str) -> File:
        """What is known of an uploaded file."""
        return File.model_validate(self._call("get_file", file_id=file_id))

    def download_file(self, file: File, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an uploaded file into a folder or to a file."""
        target = _target(to, file.name)
        path = {"file_id": file.id}
        return fetch(self._transport, "get_file_content", path, target, file.size, file.sha256, progress)

    # Jobs

    def submit(
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
    ) -> Job:
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
            "inputs": {name: self._source(value) for name, value in inputs.items()},
            "options": dict(options or {}),
            "metadata": dict(metadata or {}),
            "priority": priority,
            "webhook_url": webhook_url,
            "webhook_events": None if webhook_events is None else list(webhook_events),
        }
        if title is not None:
            body["title"] = title
        return self._submit("create_job", {}, body, wait, idempotency_key)

    def revise(
        self,
        job_id: str,
        corrections: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        metadata: Mapping[str, Any] | None = None,
        wait: float | None = None,
        idempotency_key: str | None = None,
    ) -> Job:
        """Submit an ended job again with corrections or other options: only what depends on them is worked out anew.

        A correction that is a file (the `mask` of a character, say) is given like an input: a `Path` is uploaded. None
        takes a correction back, and an option to its default. The rest is as for `submit`.
        """
        given = {
            name: self._source(v) if isinstance(v, Path | bytes | bytearray) or hasattr(v, "read") else v
            for name, v in (corrections or {}).items()
        }
        body: dict[str, Any] = {"corrections": given, "options": dict(options or {})}
        if metadata is not None:
            body["metadata"] = dict(metadata)
        return self._submit("revise_job", {"job_id": job_id}, body, wait, idempotency_key)

    def job(self, job_id: str) -> Job:
        """A job."""
        return self._job(self._call("get_job", job_id=job_id))

    def jobs(
        self,
        status: Iterable[Status | str] = (),
        kind: Iterable[str] = (),
        created_after: datetime | None = None,
        created_before: datetime | None = None,
        q: str = "",
        latest: bool = False,
    ) -> Iterator[Job]:
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
        return map(self._job, self._pages("list_jobs", asked))

    def follow(self, job_id: str, after: int = 0) -> Iterator[Event]:
        """What happens to a job, as it happens; a broken line is taken up again. Ends with the job."""
        return follow(self._transport, job_id, after)

    def rename(self, job_id: str, title: str | None) -> Job:
        """Give the work that a job is a version of a title, or take it away."""
        return self._job(self._call("change_job", json={"title": title}, job_id=job_id))

    def cancel(self, job_id: str) -> Job:
        """Cancel a job. Raises `Conflict` if it has ended otherwise."""
        return self._job(self._call("cancel_job", again=True, job_id=job_id))

    def delete(self, job_id: str) -> None:
        """Erase a job with its media."""
        self._transport.call("delete_job", path={"job_id": job_id})

    def revisions(self, job_id: str) -> list[Job]:
        """A job, what it revises, and all that revises it, oldest first."""
        return [self._job(one) for one in self._call("list_revisions", job_id=job_id)["items"]]

    def download(self, job: Job, name: str, to: str | Path = ".", progress: OnProgress | None = None) -> Path:
        """Fetch an artifact into a folder or to a file. What an earlier attempt left is taken up.

        Raises `KeyError` if the job has none of this name, `DownloadBroken` if other bytes arrive than were announced.
        """
        artifact = job.artifacts[name]
        path = {"job_id": job.id, "name": name}
        return fetch(self._transport, "get_artifact", path, _target(to, name), artifact.size, artifact.sha256, progress)

    def download_archive(self, job_id: str, to: str | Path = ".") -> Path:
        """Fetch all artifacts of an ended job as one zip."""
        target = _target(to, f"{job_id}.zip")
        draft = target.with_name(target.name + ".part")
        with self._transport.stream("get_archive", path={"job_id": job_id}) as response, draft.open("wb") as file:
            for piece in response.iter_raw():
                file.write(piece)
        return draft.replace(target)

    # Public links

    def create_link(
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
        return Link.model_validate(self._call("create_link", json=asked, job_id=job_id))

    def links(self, job_id: str) -> list[Link]:
        """The public links to a job."""
        return [Link.model_validate(one) for one in self._call("list_links", job_id=job_id)["items"]]

    def all_links(self) -> Iterator[Link]:
        """The public links to all jobs, newest first: one's own, or with the scope `admin` those of every key."""
        return map(Link.model_validate, self._pages("list_all_links", {"limit": 100}))

    def revoke_link(self, link_id: str) -> None:
        """Take a public link back."""
        self._transport.call("revoke_link", path={"link_id": link_id})

    # Kinds and drivers

    def kinds(self) -> list[Kind]:
        """The job kinds, with the JSON schemas of their inputs and options."""
        return [Kind.model_validate(one) for one in self._call("list_kinds")["items"]]

    def drivers(self) -> list[Driver]:
        """The built-in performances, then one's own driving videos."""
        return [Driver.model_validate(one) for one in self._call("list_drivers")["items"]]

    def driver(self, name: str) -> Driver:
        """A driver; once its `moments_status` is `ready`, with the portions that hold emotions."""
        return Driver.model_validate(self._call("get_driver", name=name))

    def search_driver(self, name: str) -> Driver:
        """Search one of one's own drivers for moments again."""
        return Driver.model_validate(self._call("search_driver", name=name))

    def create_driver(self, name: str, source: Upload, progress: OnProgress | None = None) -> Driver:
        """Keep a driving video under a name. It is searched for moments then: see `driver`."""
        answer = send_file(self._transport, "create_driver", source, progress, {"name": name})
        return Driver.model_validate(answer.json())

    def rename_driver(self, name: str, new: str) -> Driver:
        """Give one of one's own drivers another name. Raises `Conflict` where there is one of that name."""
        return Driver.model_validate(self._call("rename_driver", json={"name": new}, name=name))

    def delete_driver(self, name: str) -> None:
        """Erase one of one's own drivers."""
        self._transport.call("delete_driver", path={"name": name})

    # Motions

    def motions(self) -> list[Motion]:
        """The built-in motions, then one's own."""
        return [Motion.model_validate(one) for one in self._call("list_motions")["items"]]

    def motion(self, name: str) -> Motion:
        """A motion; once its `check_status` is `ready`, with its skeleton and which of its joints moves which."""
        return Motion.model_validate(self._call("get_motion", name=name))

    def create_motion(self, name: str, source: Source, progress: OnProgress | None = None) -> Motion:
        """Keep a BVH or GLB file under a name: a `Path`, or the id of an uploaded file. It is checked then: see
        `motion`."""
        if not isinstance(source, str):
            return Motion.model_validate(
                send_file(self._transport, "create_motion", source, progress, {"name": name}).json()
            )
        return Motion.model_validate(self._call("create_motion", json={"name": name, "file": source}))

    def check_motion(self, name: str) -> Motion:
        """Check one of one's own motions again."""
        return Motion.model_validate(self._call("check_motion", name=name))

    def rename_motion(self, name: str, new: str) -> Motion:
        """Give one of one's own motions another name. Raises `Conflict` where there is one of that name."""
        return Motion.model_validate(self._call("rename_motion", json={"name": new}, name=name))

    def delete_motion(self, name: str) -> None:
        """Erase one of one's own motions."""
        self._transport.call("delete_motion", path={"name": name})

    def download_motion(self, motion: Motion, to: str | Path = ".") -> Path:
        """Fetch the file of one of one's own motions to a file."""
        target = _target(to, motion.name)
        target.write_bytes(self._transport.call("get_motion_file", path={"name": motion.name}).content)
        return target

    # Webhooks

    def webhooks(self) -> list[Webhook]:
        """The endpoints that are told of jobs."""
        return [Webhook.model_validate(one) for one in self._call("list_webhooks")["items"]]

    def create_webhook(self, url: str, events: Sequence[str] | None = None, description: str = "") -> NewWebhook:
        """Have an address told of jobs. The answer carries the secret that signs the messages."""
        asked = {"url": url, "description": description, **({"events": list(events)} if events is not None else {})}
        return NewWebhook.model_validate(self._call("create_webhook", json=asked))

    def change_webhook(self, webhook_id: str, **changes: Any) -> Webhook:
        """Change an endpoint's `url`, `events`, `description` or `enabled`."""
        return Webhook.model_validate(self._call("change_webhook", json=changes, webhook_id=webhook_id))

    def delete_webhook(self, webhook_id: str) -> None:
        """Erase an endpoint with its deliveries."""
        self._transport.call("delete_webhook", path={"webhook_id": webhook_id})

    def webhook_secret(self, webhook_id: str) -> WebhookSecret:
        """The secrets that sign for an endpoint."""
        return WebhookSecret.model_validate(self._call("get_webhook_secret", webhook_id=webhook_id))

    def rotate_webhook_secret(self, webhook_id: str, overlap_hours: float = 24) -> WebhookSecret:
        """Give an endpoint a new secret; the old one signs beside it for a while."""
        asked = {"overlap_hours": overlap_hours}
        return WebhookSecret.model_validate(self._call("rotate_webhook_secret", json=asked, webhook_id=webhook_id))

    def test_webhook(self, webhook_id: str) -> Delivery:
        """Send an endpoint a message of the type `webhook.test`."""
        return Delivery.model_validate(self._call("test_webhook", webhook_id=webhook_id))

    def deliveries(
        self, status: Iterable[str] = (), webhook_id: str | None = None, job_id: str | None = None
    ) -> Iterator[Delivery]:
        """Messages and what became of them, newest first, page by page as they are asked for."""
        asked: dict[str, Any] = {"status": list(status), "limit": 100}
        asked |= {name: one for name, one in (("webhook", webhook_id), ("job", job_id)) if one is not None}
        return map(Delivery.model_validate, self._pages("list_deliveries", asked))

    def replay(self, delivery_id: str) -> Delivery:
        """Send a message again, now, under its old `webhook-id`."""
        return Delivery.model_validate(self._call("replay_delivery", delivery_id=delivery_id))

    # Keys

    def own_key(self) -> OwnKey:
        """The key that this client uses: its limits, and how much of them is used."""
        return OwnKey.model_validate(self._call("get_own_key"))

    def keys(self) -> list[Key]:
        """All keys, without their tokens. Needs the scope `admin`, as the next two do."""
        return [Key.model_validate(one) for one in self._call("list_keys")["items"]]

    def create_key(self, name: str, scopes: Sequence[str] = ("read", "submit"), **limits: float | None) -> NewKey:
        """Make a key; its token is in the answer and nowhere else.

        `limits` are `expires_in_days`, `requests_per_minute`, `jobs_at_once` and `stored_mb`.
        """
        asked = {"name": name, "scopes": list(scopes), **limits}
        return NewKey.model_validate(self._call("create_key", json=asked))

    def revoke_key(self, key_id: str, erase: bool = False) -> None:
        """Make a key worthless; with `erase`, also erase all that belongs to it."""
        self._transport.call("revoke_key", path={"key_id": key_id}, params={"erase": str(erase).lower()})

    def _pages(self, operation: str, asked: dict[str, Any]) -> Iterator[Any]:
        while True:
            page = self._transport.call(operation, params=asked).json()
            yield from page["items"]
            if page["next_cursor"] is None:
                return
            asked = {**asked, "cursor": page["next_cursor"]}

    def _call(self, operation: str, again: bool | None = None, json: Any = None, **path: str) -> Any:
        body = {} if json is None else {"json": json}
        return self._transport.call(operation, again, path=path, **body).json()

    def _submit(
        self, operation: str, path: dict[str, str], body: dict[str, Any], wait: float | None, key: str | None
    ) -> Job:
        headers = {"Idempotency-Key": key or str(uuid.uuid4())}
        timeout = self._timeout
        if wait is not None:
            headers["Prefer"] = f"wait={round(wait)}"
            timeout += wait
        answer = self._transport.call(operation, True, path=path, json=body, headers=headers, timeout=timeout)
        return self._job(answer.json())

    def _source(self, value: Source | Sequence[Source]) -> str | list[str]:
        if isinstance(value, str):
            _check_name(value)
            return value
        if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray):
            return [str(self._source(one)) for one in value]
        return self.upload(value).id

    def _job(self, document: Any) -> Job:
        return Job.model_validate(document).bound(self)


def _target(to: str | Path, name: str) -> Path:
    """The file to write: in the folder, or the one that was named. Missing folders are made."""
    path = Path(to)
    if path.is_dir() or path.suffix == "":
        path.mkdir(parents=True, exist_ok=True)
        return path / Path(name).name
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def _address(given: str) -> httpx.URL:
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
