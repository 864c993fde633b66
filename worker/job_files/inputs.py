"""Inputs that are addresses are fetched one after another before the work begins, and kept as files of the job like
uploads. Each is fetched in a thread of its own, so that the attempt can be watched meanwhile."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from service.auth.quotas import require_room
from service.clock import now
from service.context import Context
from service.files.service import record
from service.ids import new_id
from service.jobs import leases
from service.jobs.inputs import ValueRefused, require_media
from service.jobs.leases import Lease
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE
from service.tables.files import File
from service.tables.jobs import Job, JobFile
from worker.job_files.fetch import Fetched, FetchFailed, FetchStopped, fetch


def addresses(sources: dict[str, Any]) -> list[str]:
    """The addresses among a job's sources that are still to be fetched, each once."""
    each = [one for source in sources.values() for one in (source if isinstance(source, list) else [source])]
    return list(dict.fromkeys(one["url"] for one in each if "url" in one))


class RunningFetch:
    """A fetch under way."""

    def __init__(self, context: Context, url: str, folder: Path):
        self.url = url
        self._come: tuple[int, int | None] = (0, None)
        self._stopped = threading.Event()
        self._ended = threading.Event()
        self._outcome: Fetched | BaseException = FetchStopped()
        arguments = (context, folder / new_id())
        threading.Thread(target=self._fetch, args=arguments, name="fetch", daemon=True).start()

    def _fetch(self, context: Context, path: Path) -> None:
        try:
            self._outcome = fetch(context.settings, self.url, path, self._note, self._stopped.is_set)
        except BaseException as error:
            self._outcome = error
        finally:
            self._ended.set()

    def _note(self, come: int, announced: int | None) -> None:
        self._come = come, announced

    def ended(self, seconds: float) -> bool:
        """Whether it has ended, waiting up to so long for it."""
        return self._ended.wait(seconds)

    def stop(self) -> None:
        """Give it up. The thread ends as soon as something comes, or does not come for a while."""
        self._stopped.set()

    def result(self) -> Fetched:
        """What was fetched. Raises `FetchFailed`, OSError."""
        if isinstance(self._outcome, BaseException):
            raise self._outcome
        return self._outcome

    @property
    def fraction(self) -> float:
        come, announced = self._come
        return min(come / announced, 1.0) if announced else 0.0

    @property
    def message(self) -> str:
        """How far it is, for people; the address itself may hold secrets, and stays out of it."""
        come, announced = self._come
        of = f" of {announced / BYTES_PER_MEGABYTE:.1f}" if announced else ""
        return f"{come / BYTES_PER_MEGABYTE:.1f}{of} MB from {urlsplit(self.url).hostname}"


def keep(context: Context, job: Job, lease: Lease, url: str, fetched: Fetched) -> dict[str, Any] | None:
    """Make what was fetched a file of the job, and its source in place of the address.

    Returns the job's sources then; None if the lease is lost. Raises `FetchFailed`, OSError.
    """
    for item in context.kinds[job.kind].inputs:
        source = job.sources.get(item.name)
        if {"url": url} in (source if isinstance(source, list) else [source]):
            try:
                require_media(item, fetched.content_type)
            except ValueRefused as refused:
                raise FetchFailed(refused.code, refused.detail) from refused
    file = File(
        id=new_id(),
        owner=job.owner,
        name=fetched.name,
        content_type=fetched.content_type,
        size=fetched.size,
        sha256=fetched.sha256,
        created_at=now(),
    )
    sources = {name: _replaced(source, url, file.id) for name, source in job.sources.items()}
    context.storage.adopt(file.key, fetched.path)
    try:
        with context.database.write() as session:
            held = leases.update_job(session, lease, sources=sources, fruitless_attempts=0)
            if held:
                require_room(session, context.settings, job.owner, file.size)
                record(session, file)
                session.add(JobFile(job_id=job.id, file_id=file.id))
    except Problem as problem:
        context.storage.delete([file.key])
        raise FetchFailed(problem.code, problem.detail) from problem
    if not held:
        context.storage.delete([file.key])
        return None
    fetched.path.unlink(missing_ok=True)
    return sources


def _replaced(source: Any, url: str, file_id: str) -> Any:
    if isinstance(source, list):
        return [_replaced(one, url, file_id) for one in source]
    return {"file": file_id} if source == {"url": url} else source
