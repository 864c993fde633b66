"""What was found in what a user keeps: read from what the job that inspected it has left, and kept nowhere else, so that
it goes with it."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, Literal, TypeVar

import structlog
from pydantic import BaseModel, ValidationError

from service.context import Context
from service.job_records import artifacts, jobs
from service.libraries.library import Library
from service.storage.files import Storage
from service.tables.artifacts import Artifact
from service.tables.jobs import Status
from service.tables.kept import Kept

MAX_DOCUMENT_BYTES = 1_000_000
"""What is read of a document at most: the process that wrote it may be in a stranger's hands."""

CACHED_DOCUMENTS = 1000
"""Documents; an artifact never changes under its key."""

InspectionStatus = Literal["none", "pending", "ready", "failed"]

D = TypeVar("D", bound=BaseModel)


@dataclass(frozen=True)
class Inspection(Generic[D]):
    """How far the inspection of a kept file is, what it found once it is `ready`, and why it `failed`."""

    status: InspectionStatus
    document: D | None = None
    error: Mapping[str, Any] | None = None


def inspections_of(
    context: Context, library: Library, model: type[D], kept: Sequence[Kept]
) -> dict[str, Inspection[D]]:
    """What was found in each of the files that one owner keeps, by their names; documents are read as `model`."""
    begun = [one.inspection_job for one in kept if one.inspection_job is not None]
    if not begun:
        return {one.name: Inspection("none") for one in kept}
    with context.database.read() as session:
        ends = jobs.end_states(session, begun)
        left = artifacts.of_jobs(session, list(ends))
    found: dict[str, Inspection[D]] = {}
    for one in kept:
        job_id = one.inspection_job or ""
        document = next((artifact for artifact in left.get(job_id, ()) if artifact.name == library.document), None)
        found[one.name] = _inspection(context, model, ends.get(job_id), document)
    return found


def _inspection(
    context: Context, model: type[D], end: tuple[Status, Mapping[str, Any] | None] | None, document: Artifact | None
) -> Inspection[D]:
    if end is None:
        return Inspection("none")
    status, error = end
    if not status.final:
        return Inspection("pending")
    if status != Status.SUCCEEDED or document is None or document.size > MAX_DOCUMENT_BYTES:
        return Inspection("failed", error=error)
    read = _read(context.storage, document.key, model)
    return Inspection("ready" if read is not None else "failed", read)


@lru_cache(maxsize=CACHED_DOCUMENTS)
def _read(storage: Storage, key: str, model: type[D]) -> D | None:
    with tempfile.TemporaryDirectory(prefix="galatea-") as folder:
        text = storage.fetch(key, Path(folder) / "document.json").read_bytes()
    try:
        return model.model_validate(json.loads(text))
    except (ValueError, RecursionError, ValidationError) as error:
        structlog.get_logger().warning("document_unreadable", key=key, reason=str(error)[:500])
        return None
