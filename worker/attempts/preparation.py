"""What an attempt at a job begins with: its folders, its inputs as files, and what its process is told."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from engine.store import StageStore
from service.catalogue.allowance import Allowance
from service.context import Context
from service.files import analyses
from service.files import repository as files
from service.job_records import artifacts
from service.jobs.leases import Lease
from service.settings import BYTES_PER_MEGABYTE
from service.tables.jobs import Job
from worker.job_files.fetch import FetchFailed
from worker.job_files.mirror import Mirror


@dataclass(frozen=True)
class Folders:
    """Where an attempt works: all its own is under `attempt`; `stages` are those of the job's tree of revisions, and
    `mirrored` is for their copies on the way to the storage."""

    attempt: Path
    stages: Path
    mirrored: Path

    @classmethod
    def of(cls, context: Context, job: Job, lease: Lease) -> Folders:
        own, tree = context.settings.job_folder(job.id), context.settings.job_folder(job.tree)
        return cls(own / f"attempt-{lease.token}", tree / "stages", own / f"mirror-{lease.token}")

    @property
    def out(self) -> Path:
        return self.attempt / "out"

    @property
    def temporary(self) -> Path:
        return self.attempt / "temporary"

    @property
    def inputs(self) -> Path:
        return self.attempt / "inputs"

    @property
    def fetched(self) -> Path:
        return self.attempt / "fetched"


def prepare(
    context: Context, job: Job, folders: Folders, mirror: Mirror, allowance: Allowance, user: int | None
) -> dict[str, Any]:
    """Lay out the folders, fetch what lies elsewhere, and let `user`, who works, change what is theirs.

    Returns the command for the process. Takes as long as the storage does: the lease must be kept meanwhile.

    Raises `FetchFailed` where what an earlier job made is not there any more.
    """
    for left in folders.attempt.parent.glob("*-*"):  # by an attempt whose worker was killed
        shutil.rmtree(left, ignore_errors=True)
    for folder in (folders.out, folders.temporary, folders.inputs, folders.mirrored, folders.stages):
        folder.mkdir(parents=True, exist_ok=True)
    StageStore(folders.stages).discard_drafts()
    os.utime(folders.stages.parent)  # housekeeping sees that it is in use
    mirror.restore()
    local = {name: _local(context, source, folders.inputs) for name, source in job.sources.items()}
    shared = _shared(context, job) or folders.stages
    shared.mkdir(parents=True, exist_ok=True)
    if user is not None:
        _hand_over((folders.out, folders.temporary, folders.stages, shared), user)
    return {
        "command": "work",
        "kind": job.kind,
        "inputs": local,
        "options": job.options,
        "out": str(folders.out),
        "temporary": str(folders.temporary),
        "stages": str(folders.stages),
        "shared": str(shared),
        "mark_synthetic": context.settings.mark_synthetic,
        "limits": asdict(context.settings.limits),
        "memory_bytes": int(allowance.memory_mb * BYTES_PER_MEGABYTE),
        "cores": allowance.cores,
    }


def _shared(context: Context, job: Job) -> Path | None:
    """Where analyses lie that serve other jobs with the same input too."""
    kind = context.kinds[job.kind]
    name = next((one.name for one in kind.inputs if one.serves_many and not one.many), None)
    source = job.sources.get(name) if name is not None else None
    if source is None:
        return None
    if "library" in source:
        return analyses.folder(context.settings, analyses.LIBRARY_OWNER, source["name"])
    if "file" not in source:  # candidates, whose analyses are kept with the job, or nothing that would be there
        return None
    with context.database.read() as session:
        file = files.get(session, job.owner, source["file"])
    return analyses.folder(context.settings, file.owner, file.sha256) if file is not None else None


def _local(context: Context, source: Any, folder: Path) -> Any:
    """A source as the process takes it: the path of a file, fetched into the folder where it lies elsewhere."""
    if isinstance(source, list):
        return [_local(context, one, folder) for one in source]
    if "candidates" in source:
        return {"candidates": {name: _local(context, one, folder) for name, one in source["candidates"].items()}}
    if "job" in source:
        return str(_artifact(context, source["job"], source["artifact"], folder))
    if "file" not in source:
        return source
    return str(context.storage.fetch(f"files/{source['file']}", folder / source["file"]))


def _artifact(context: Context, job_id: str, name: str, folder: Path) -> Path:
    """What an earlier job made, as a local file."""
    with context.database.read() as session:
        made = artifacts.get(session, job_id, name)
        key, own = (made.key, folder / made.id) if made is not None else ("", folder)
    try:
        if key:
            return context.storage.fetch(key, own)
    except FileNotFoundError:
        pass  # erased in this very moment
    raise FetchFailed(
        "input_erased", "The job whose result this one begins with was erased, and all of it: give another."
    )


def _hand_over(folders: Sequence[Path], user: int) -> None:
    """Let a user change these folders and what lies directly in them. Only for folders that this user alone changes."""
    for folder in folders:
        for path in (folder, *folder.iterdir()):
            os.chown(path, user, user, follow_symlinks=False)
