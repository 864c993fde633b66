"""An owner's jobs, as they are found and shown: a job of somebody else is none."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy.orm import Session

from service.auth import repository as keys
from service.context import Context
from service.job_records import artifacts, jobs
from service.job_records.schemas import JobOut, JobTree
from service.job_records.signed_links import Signer
from service.problems import Problem
from service.tables.jobs import Job, Status


def own_job(session: Session, owner: str, job_id: str) -> Job:
    """The owner's job, or a 404 problem."""
    job = jobs.get(session, job_id)
    if job is None or job.owner != owner:
        raise _missing()
    return job


def lock_own_job(session: Session, owner: str, job_id: str) -> Job:
    """The owner's job, locked until the transaction ends, or a 404 problem."""
    job = jobs.get_locked(session, job_id)
    if job is None or job.owner != owner:
        raise _missing()
    return job


def job_view(context: Context, owner: str, job_id: str) -> JobOut:
    """The job as the API shows it, or a 404 problem."""
    with context.database.read() as session:
        return job_views(context, session, owner, [own_job(session, owner, job_id)])[0]


def tree_view(context: Context, owner: str, job_id: str) -> JobTree:
    """A job with all its relations by revision, or a 404 problem."""
    with context.database.read() as session:
        tree = jobs.tree(session, own_job(session, owner, job_id).tree)
        return JobTree(items=job_views(context, session, owner, tree))


def job_views(context: Context, session: Session, owner: str, some: Sequence[Job]) -> list[JobOut]:
    """An owner's jobs as the API shows them, with links to what they made."""
    made = artifacts.of_jobs(session, [job.id for job in some])
    key = keys.get(session, owner) if any(made.values()) else None  # which signs the links
    signer = Signer.of(key, context.settings) if key is not None else None
    places = jobs.queue_places(session, [job for job in some if job.status == Status.QUEUED])
    return [JobOut.of(job, made[job.id], signer, places.get(job.id)) for job in some]


def queue_place(context: Context, job: Job) -> int:
    """The place in the queue of a job that was accepted just now; of one that a worker has by now, it was the first."""
    with context.database.read() as session:
        return jobs.queue_places(session, [job]).get(job.id, 1)


def _missing() -> Problem:
    return Problem(404, "job_not_found", "There is no such job: it was deleted, or it never was.")
