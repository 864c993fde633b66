"""The look into what a user keeps: a job like any other, which begins by itself, since nothing is decoded outside of
jobs. What it found is read from what it left, and kept nowhere else, so that it goes with it."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, Literal, TypeVar

import structlog
from pydantic import BaseModel, ValidationError

from service.artifacts import repository as artifacts
from service.context import Context
from service.jobs import repository as jobs
from service.jobs import service
from service.jobs.schemas import JobIn
from service.kept import repository
from service.kept.shelves import Shelf
from service.problems import Problem
from service.storage import Storage
from service.tables.artifacts import Artifact
from service.tables.jobs import Status
from service.tables.kept import Kept

DOCUMENT_BYTES = 1_000_000
"""What is read of a document at most: the process that wrote it may be in a stranger's hands."""

KEPT_IN_MEMORY = 1000
"""Documents; an artifact never changes under its key."""

LookStatus = Literal["none", "pending", "ready", "failed"]

D = TypeVar("D", bound=BaseModel)


@dataclass(frozen=True)
class Look(Generic[D]):
    """How far the look into a kept file is, what it found once it is `ready`, and why it `failed`."""

    status: LookStatus
    document: D | None = None
    error: Mapping[str, Any] | None = None


def look_into(context: Context, shelf: Shelf, owner: str, name: str, file_id: str) -> None:
    """Begin to look into what is new, where the kind is on offer and the owner may have one more job under way:
    otherwise it can be asked for later, and what is kept is of use without it."""
    if shelf.kind not in context.kinds:
        return
    try:
        begin(context, shelf, owner, name, file_id)
    except Problem as problem:
        structlog.get_logger().info("not_looked_into", shelf=shelf.noun, name=name, reason=problem.code)


def begin(context: Context, shelf: Shelf, owner: str, name: str, file_id: str) -> None:
    """Submit the job that looks into a kept file. Raises `Problem`."""
    asked = JobIn(kind=shelf.kind, inputs={shelf.noun: file_id}, metadata={shelf.noun: name})
    job, _ = service.submit(context, owner, asked, {}, None)
    with context.database.write() as session:
        there = repository.set_look_job(session, shelf, owner, name, job.id)
    if not there:  # it was deleted in the meantime
        forget(context, owner, job.id)


def under_way(context: Context, kept: Kept) -> bool:
    """Whether a job looks into it now."""
    if kept.look_job is None:
        return False
    with context.database.read() as session:
        end = jobs.ends(session, [kept.look_job]).get(kept.look_job)
    return end is not None and not end[0].final


def forget(context: Context, owner: str, job_id: str | None) -> None:
    """Erase a look with all that it found; one that is under way stops."""
    if job_id is not None:
        with suppress(Problem):  # its owner was faster
            service.delete(context, owner, job_id)


def looks_into(context: Context, shelf: Shelf, model: type[D], kept: Sequence[Kept]) -> dict[str, Look[D]]:
    """What was found in each of the files that one owner keeps, by their names; documents are read as `model`."""
    begun = [one.look_job for one in kept if one.look_job is not None]
    if not begun:
        return {one.name: Look("none") for one in kept}
    with context.database.read() as session:
        ends = jobs.ends(session, begun)
        left = artifacts.of_jobs(session, list(ends))
    found: dict[str, Look[D]] = {}
    for one in kept:
        job_id = one.look_job or ""
        document = next((artifact for artifact in left.get(job_id, ()) if artifact.name == shelf.document), None)
        found[one.name] = _look(context, model, ends.get(job_id), document)
    return found


def _look(
    context: Context, model: type[D], end: tuple[Status, Mapping[str, Any] | None] | None, document: Artifact | None
) -> Look[D]:
    if end is None:
        return Look("none")
    status, error = end
    if not status.final:
        return Look("pending")
    if status != Status.SUCCEEDED or document is None or document.size > DOCUMENT_BYTES:
        return Look("failed", error=error)
    read = _read(context.storage, document.key, model)
    return Look("ready" if read is not None else "failed", read)


@lru_cache(maxsize=KEPT_IN_MEMORY)
def _read(storage: Storage, key: str, model: type[D]) -> D | None:
    with tempfile.TemporaryDirectory(prefix="galatea-") as folder:
        text = storage.fetch(key, Path(folder) / "document.json").read_bytes()
    try:
        return model.model_validate(json.loads(text))
    except (ValueError, RecursionError, ValidationError) as error:
        structlog.get_logger().warning("document_unreadable", key=key, reason=str(error)[:500])
        return None
