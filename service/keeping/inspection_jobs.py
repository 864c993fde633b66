"""The inspection of what a user keeps: a job like any other, which begins by itself, since nothing is decoded outside of
jobs. What it finds is read by `service.libraries.inspections`."""

from __future__ import annotations

from contextlib import suppress

import structlog

from service.context import Context
from service.job_records import jobs
from service.jobs import service
from service.jobs.schemas import JobIn
from service.libraries import repository
from service.libraries.library import Library
from service.problems import Problem
from service.tables.kept import Kept


def inspect_new(context: Context, library: Library, owner: str, name: str, file_id: str) -> None:
    """Begin to inspect what is new, where the kind is on offer and the owner may have one more job under way:
    otherwise it can be asked for later, and what is kept is of use without it."""
    if library.kind not in context.kinds:
        return
    try:
        begin(context, library, owner, name, file_id)
    except Problem as problem:
        structlog.get_logger().info("not_inspected", library=library.noun, name=name, reason=problem.code)


def begin(context: Context, library: Library, owner: str, name: str, file_id: str) -> None:
    """Submit the job that inspects a kept file. Raises `Problem`."""
    requested = JobIn(kind=library.kind, inputs={library.noun: file_id}, metadata={library.noun: name})
    job, _ = service.submit(context, owner, requested, {}, None)
    with context.database.write() as session:
        there = repository.set_inspection_job(session, library, owner, name, job.id)
    if not there:  # it was deleted in the meantime
        forget(context, owner, job.id)


def under_way(context: Context, kept: Kept) -> bool:
    """Whether a job inspects it now."""
    if kept.inspection_job is None:
        return False
    with context.database.read() as session:
        end = jobs.end_states(session, [kept.inspection_job]).get(kept.inspection_job)
    return end is not None and not end[0].final


def forget(context: Context, owner: str, job_id: str | None) -> None:
    """Erase an inspection with all that it found; one that is under way stops."""
    if job_id is not None:
        with suppress(Problem):  # its owner was faster
            service.delete(context, owner, job_id)
