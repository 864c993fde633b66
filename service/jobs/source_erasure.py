"""Erasing what a job was made of once it has succeeded: clips of a person, where the operator wants them gone (`ERASE_SOURCES`).

What stays of them is their content's hash, by which a revision finds what the stages have found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from engine.kind import Kind
from service.files import repository as files
from service.job_records import jobs
from service.jobs.inputs import files_in
from service.tables.files import File
from service.tables.jobs import Job, JobFile, Status


def erase_sources(session: Session, kind: Kind, job_id: str) -> list[File]:
    """Take the inputs that are `personal` from a job and from all of its tree that have ended.

    Returns the files that were thereby erased; what they have in the storage is free once the session has been committed
    (`service.files.service.forget`). A file that another job uses, or that is kept under a name, stays.
    """
    personal = {item.name for item in kind.inputs if item.personal}
    done = jobs.get(session, job_id)
    if done is None or not personal:
        return []
    taken: set[str] = set()
    for job in jobs.tree(session, done.tree):
        if job.id == job_id or Status(job.status).final:
            taken |= _take(session, job, personal)
    return files.erase_unused(session, sorted(taken))


def _take(session: Session, job: Job, personal: set[str]) -> set[str]:
    """Take the inputs of these names from a job; the ids of the files that it does not use any more."""
    own = {name: source for name, source in job.sources.items() if name in personal}
    contents = _contents(session, files_in(own))
    job.sources = {name: _erased(one, contents) if name in own else one for name, one in job.sources.items()}
    unused = set(contents) - files_in(job.sources)
    session.execute(delete(JobFile).where(JobFile.job_id == job.id, JobFile.file_id.in_(unused)))
    return unused


def _contents(session: Session, ids: set[str]) -> dict[str, str]:
    """The SHA-256 of files by their ids."""
    found: Sequence[File] = session.scalars(select(File).where(File.id.in_(ids))).all()
    return {file.id: file.sha256 for file in found}


def _erased(source: Any, contents: Mapping[str, str]) -> Any:
    if isinstance(source, list):
        return [_erased(one, contents) for one in source]
    return {"erased": contents[source["file"]]} if source.get("file") in contents else source
