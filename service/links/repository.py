"""Queries about public links."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, or_, select
from sqlalchemy.orm import Session

from service.auth.tokens import digest
from service.clock import now
from service.tables.keys import Key
from service.tables.links import PublicLink


def of_job(session: Session, job_id: str) -> Sequence[PublicLink]:
    """A job's links, oldest first."""
    return session.scalars(select(PublicLink).where(PublicLink.job_id == job_id).order_by(PublicLink.id)).all()


def page(session: Session, owner: str | None, limit: int, before_id: str | None) -> Sequence[PublicLink]:
    """An owner's links, or everybody's, newest first."""
    query = select(PublicLink).order_by(PublicLink.id.desc()).limit(limit)
    if owner is not None:
        query = query.where(PublicLink.owner == owner)
    if before_id is not None:
        query = query.where(PublicLink.id < before_id)
    return session.scalars(query).all()


def valid_link(session: Session, token: str) -> PublicLink | None:
    """The link with this token, if it has not expired and the key that made it was not revoked."""
    ahead = or_(PublicLink.expires_at.is_(None), PublicLink.expires_at > now())
    query = select(PublicLink).join(Key, Key.id == PublicLink.owner)
    return session.scalar(query.where(PublicLink.token_hash == digest(token), ahead, Key.revoked_at.is_(None)))


def revoke(session: Session, owner: str | None, link_id: str) -> bool:
    """Take an owner's link back, or anybody's. Returns whether there was one."""
    query = delete(PublicLink).where(PublicLink.id == link_id)
    gone = session.execute(query if owner is None else query.where(PublicLink.owner == owner))
    return bool(gone.rowcount)  # type: ignore[attr-defined]


def revoke_all(session: Session, owner: str | None = None) -> int:
    """Take all links of an owner back, or everybody's. Returns how many there were."""
    query = delete(PublicLink)
    gone = session.execute(query if owner is None else query.where(PublicLink.owner == owner))
    return int(gone.rowcount)  # type: ignore[attr-defined]


def forget_expired(session: Session) -> None:
    session.execute(delete(PublicLink).where(PublicLink.expires_at < now()))
