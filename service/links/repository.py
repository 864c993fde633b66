"""Queries about public links."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, or_, select
from sqlalchemy.orm import Session

from service.clock import now
from service.links.models import PublicLink


def of_job(session: Session, job_id: str) -> Sequence[PublicLink]:
    """A job's links, oldest first."""
    return session.scalars(select(PublicLink).where(PublicLink.job_id == job_id).order_by(PublicLink.id)).all()


def good(session: Session, token: str) -> PublicLink | None:
    """The link with this token, if it has not expired."""
    ahead = or_(PublicLink.expires_at.is_(None), PublicLink.expires_at > now())
    return session.scalar(select(PublicLink).where(PublicLink.token == token, ahead))


def revoke(session: Session, owner: str, link_id: str) -> bool:
    """Take an owner's link back. Returns whether there was one."""
    gone = session.execute(delete(PublicLink).where(PublicLink.id == link_id, PublicLink.owner == owner))
    return bool(gone.rowcount)  # type: ignore[attr-defined]


def forget_expired(session: Session) -> None:
    session.execute(delete(PublicLink).where(PublicLink.expires_at < now()))
