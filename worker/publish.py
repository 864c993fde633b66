"""Publishing what a job made: into the storage under a name of ours, then visible by one change in SQL."""

from __future__ import annotations

import hashlib
import os
import re
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO

from sqlalchemy.orm import Session

from service.artifacts import repository
from service.artifacts.models import Artifact
from service.artifacts.schemas import ArtifactOut
from service.clock import now
from service.context import Context
from service.events import repository as events
from service.ids import new_id
from service.jobs import leases
from service.jobs.leases import Lease
from worker.content_types import content_type

NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,127}")


class Refused(Exception):
    """What the process left is no artifact: a name that cannot be one, a link, a folder."""


def publish(context: Context, lease: Lease, path: Path) -> tuple[int, int] | None:
    """Publish one artifact of a job that goes on.

    Returns its size and time of change, by which `publish_all` sees whether it is still the same; None if the
    lease is lost. Raises `Refused`, OSError.
    """
    artifact, mark = _store(context, lease, path)
    with context.database.write() as session:
        held = leases.change(session, lease)
        freed = _record(session, artifact) if held else artifact.key
    context.storage.delete([freed] if freed else [])
    return mark if held else None


def publish_all(context: Context, lease: Lease, out: Path, published: Mapping[str, tuple[int, int]]) -> bool:
    """Publish everything in `out` that is not published yet and end the job as succeeded, all by one change.

    Returns False if the lease was lost: then nothing is published. Raises `Refused`, OSError.
    """
    artifacts = []
    try:
        for path in sorted(out.iterdir()):
            if published.get(path.name) != _mark(path.lstat()):
                artifacts.append(_store(context, lease, path)[0])
                with context.database.write() as session:
                    leases.change(session, lease)
        with context.database.write() as session:
            held = leases.holds(session, lease)
            freed = [_record(session, artifact) for artifact in artifacts] if held else []
            held = held and leases.succeed(session, lease)
    except BaseException:
        context.storage.delete(artifact.key for artifact in artifacts)
        raise
    context.storage.delete([key for key in freed if key] if held else [artifact.key for artifact in artifacts])
    return held


def _store(context: Context, lease: Lease, path: Path) -> tuple[Artifact, tuple[int, int]]:
    if NAME.fullmatch(path.name) is None:
        raise Refused(f"“{path.name}” cannot be the name of an artifact")
    with _opened(path) as file:
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


def _opened(path: Path) -> BinaryIO:
    """The file itself, never what a link points at: the process that made it may be in a stranger's hands."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        raise Refused(f"“{path.name}” is not a plain file: {error.strerror}") from error
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise Refused(f"“{path.name}” is not a plain file")
    return os.fdopen(descriptor, "rb")


def _mark(status: os.stat_result) -> tuple[int, int]:
    return status.st_size, status.st_mtime_ns


def _record(session: Session, artifact: Artifact) -> str | None:
    freed = repository.replace(session, artifact)
    data = {"name": artifact.name, **ArtifactOut.of(artifact).model_dump()}
    events.append(session, artifact.job_id, "artifact", data)
    return freed
