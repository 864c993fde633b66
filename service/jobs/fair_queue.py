"""Whose turn it is: the order in which queued jobs are claimed."""

from __future__ import annotations

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session, aliased

from service.jobs.leases import Lease, claim
from service.tables.jobs import Job, Status


def claim_next(session: Session, kind: str, owner: str, seconds: float) -> Lease | None:
    """Take the queued job of a kind whose turn it is; None if none is queued.

    The highest priority comes first. Among equals it is the key of which the fewest jobs run, so that a long list of
    one key does not hold up the others. Then it is whoever came first.
    """
    while (job_id := session.scalar(_in_turn(kind))) is not None:
        if (lease := claim(session, job_id, owner, seconds)) is not None:
            return lease  # otherwise another worker was faster
    return None


def _in_turn(kind: str) -> Select[str]:
    waits = (Job.status == Status.QUEUED) & (Job.kind == kind)
    urgent = select(func.min(Job.priority)).where(waits).scalar_subquery()
    firsts = select(func.min(Job.id)).where(waits, Job.priority == urgent).group_by(Job.owner)
    other = aliased(Job)
    running = select(func.count(other.id)).where(other.owner == Job.owner, other.status == Status.RUNNING)
    in_turn = running.correlate(Job).scalar_subquery()
    return select(Job.id).where(Job.id.in_(firsts)).order_by(in_turn, Job.id).limit(1)
