"""Publishing what a job made: into the storage under a name of ours, then visible by one change in SQL."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from service.clock import now
from service.context import Context
from service.events import repository as events
from service.files.service import forget
from service.ids import new_id
from service.job_records import artifacts as repository
from service.job_records import jobs
from service.job_records.schemas import ArtifactOut
from service.jobs import leases
from service.jobs.leases import Lease
from service.jobs.source_erasure import erase_sources
from service.tables.artifacts import Artifact
from service.tables.files import File
from worker.job_files.content_types import content_type
from worker.job_files.plain_files import FileRefused, open_plain
from worker.retry_db import retry_db

REPORT_BYTES = 1_000_000
"""Bytes of a report that are read: the process that wrote it may be in a stranger's hands."""
MAX_REPORT_STAGES = 40
"""Stages of a report that are read."""


def publish(context: Context, lease: Lease, path: Path) -> tuple[int, int] | None:
    """Publish one artifact of a job that goes on.

    Returns its size and time of change, by which `publish_all` sees whether it is still the same; None if the
    lease is lost. Raises `FileRefused`, OSError.
    """
    artifact, mark = _store(context, lease, path)

    def record() -> tuple[bool, str | None]:
        with context.database.write() as session:
            if not leases.update_job(session, lease):
                return False, None
            return True, _record(session, _copy(artifact))

    held, freed = retry_db(record, lease.seconds)
    if not held:
        _erase_unrecorded(context, [artifact])
        return None
    context.storage.delete([freed] if freed else [])
    return mark


def publish_all(context: Context, lease: Lease, out: Path, published: Mapping[str, tuple[int, int]]) -> bool:
    """Publish everything in `out` that is not published yet and end the job as succeeded, all by one change. What it
    was made of is erased, where the operator wants that.

    Returns False if the lease was lost: then nothing is published. Raises `FileRefused`, OSError.
    """
    artifacts: list[Artifact] = []
    sources: list[File] = []

    def record() -> list[str | None] | None:
        with context.database.write() as session:
            if not leases.update_job(session, lease):
                return None
            freed = [_record(session, _copy(artifact)) for artifact in artifacts]
            leases.succeed(session, lease)
            sources[:] = _erase_sources(context, session, lease)
            leases.count_stages(session, lease, seconds)
            return freed

    try:
        for path in sorted(out.iterdir()):
            if published.get(path.name) != _mark(path.lstat()):
                artifacts.append(_store(context, lease, path)[0])
        seconds = _stage_seconds(out)
        freed = retry_db(record, lease.seconds)
    except BaseException:
        _erase_unrecorded(context, artifacts)
        raise
    if freed is None:
        return _erase_unrecorded(context, artifacts)
    context.storage.delete(key for key in freed if key)
    forget(context, sources)
    return True


def _erase_unrecorded(context: Context, artifacts: Sequence[Artifact]) -> bool:
    """Erase what was stored in vain. Returns whether it was recorded after all: an answer of the database can get lost
    although it has done what it was asked. While it cannot be asked, everything stays, and housekeeping sees to it."""
    try:
        with context.database.read() as session:
            recorded = repository.existing_ids(session, [artifact.id for artifact in artifacts])
    except SQLAlchemyError:
        return False
    context.storage.delete(artifact.key for artifact in artifacts if artifact.id not in recorded)
    return len(artifacts) > 0 and len(recorded) == len(artifacts)


def _erase_sources(context: Context, session: Session, lease: Lease) -> list[File]:
    """Erase the clips of a person that a job was made of, if the operator wants that; the files."""
    job = jobs.get(session, lease.job_id)
    if job is None or not context.settings.erase_sources or job.kind not in context.kinds:
        return []
    return erase_sources(session, context.kinds[job.kind], job.id)


def _stage_seconds(out: Path) -> dict[str, float]:
    """How long the stages took, as the report says; nothing where it says nothing that can be believed."""
    try:
        with open_plain(out / "report.json") as file:
            stages = json.loads(file.read(REPORT_BYTES))["stages"].items()
        return {str(name): float(spent) for name, spent in list(stages)[:MAX_REPORT_STAGES] if 0 <= float(spent) < 1e6}
    except (FileRefused, OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return {}


def _store(context: Context, lease: Lease, path: Path) -> tuple[Artifact, tuple[int, int]]:
    with open_plain(path) as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        status = os.fstat(file.fileno())
        artifact = Artifact(
            id=new_id(),
            job_id=lease.job_id,
            name=path.name,
            content_type=content_type(path.name),
            size=status.st_size,
            sha256=digest,
            created_at=now(),
        )
        file.seek(0)
        context.storage.put(artifact.key, file)
    return artifact, _mark(status)


def _copy(artifact: Artifact) -> Artifact:
    """An artifact anew, for another session: an attempt to record it may have failed in an earlier one."""
    return Artifact(**{column.key: getattr(artifact, column.key) for column in Artifact.__table__.columns})


def _mark(status: os.stat_result) -> tuple[int, int]:
    return status.st_size, status.st_mtime_ns


def _record(session: Session, artifact: Artifact) -> str | None:
    freed = repository.replace(session, artifact)
    data = {"name": artifact.name, **ArtifactOut.of(artifact).model_dump(exclude_none=True)}
    events.append(session, artifact.job_id, "artifact", data)
    return freed
