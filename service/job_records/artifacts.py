"""Queries about artifacts."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from service.tables.artifacts import Artifact


def of_jobs(session: Session, job_ids: Sequence[str]) -> dict[str, list[Artifact]]:
    """The artifacts of jobs, by job id, in the order of their names."""
    query = select(Artifact).where(Artifact.job_id.in_(job_ids)).order_by(Artifact.name)
    found: dict[str, list[Artifact]] = {job_id: [] for job_id in job_ids}
    for artifact in session.scalars(query):
        found[artifact.job_id].append(artifact)
    return found


def get(session: Session, job_id: str, name: str) -> Artifact | None:
    return session.scalar(select(Artifact).where(Artifact.job_id == job_id, Artifact.name == name))


def replace(session: Session, artifact: Artifact) -> str | None:
    """Publish an artifact; the storage key of the older one of the same name is free then and is returned."""
    older = get(session, artifact.job_id, artifact.name)
    if older is not None and older.id == artifact.id:
        return None  # it had been recorded, and only the database's answer got lost
    if older is not None:
        session.execute(delete(Artifact).where(Artifact.id == older.id))
    session.add(artifact)
    return older.key if older is not None else None


def existing_ids(session: Session, ids: Sequence[str]) -> set[str]:
    """Which of these ids are artifacts."""
    return set(session.scalars(select(Artifact.id).where(Artifact.id.in_(ids))))
