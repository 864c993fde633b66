"""Queries about keys, and about what belongs to them."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from sqlalchemy import BindParameter, bindparam, func, or_, select, update
from sqlalchemy.orm import Session

from service.auth.tokens import digest
from service.clock import now
from service.tables.artifacts import Artifact
from service.tables.files import File
from service.tables.jobs import Job, Status
from service.tables.keys import LOCAL_KEY_ID, Key
from service.tables.uploads import Upload

USE_NOTED_EVERY = timedelta(minutes=1)
"""The use of a key is noted no more often than this."""

# What every request asks is put together once.
_OWNER_PARAMETER: BindParameter[str] = bindparam("owner")
OF_TOKEN = select(Key).where(Key.token_hash == bindparam("digest"))
UNDER_WAY = (
    select(func.count())
    .select_from(Job)
    .where(Job.owner == _OWNER_PARAMETER, or_(Job.status == Status.QUEUED, Job.status == Status.RUNNING))
)
STORED_BYTES = select(
    select(func.sum(File.size)).where(File.owner == _OWNER_PARAMETER).scalar_subquery(),
    select(func.sum(Artifact.size))
    .join(Job, Job.id == Artifact.job_id)
    .where(Job.owner == _OWNER_PARAMETER)
    .scalar_subquery(),
    select(func.sum(func.coalesce(Upload.length, Upload.received)))
    .where(Upload.owner == _OWNER_PARAMETER, Upload.file_id.is_(None))
    .scalar_subquery(),
)


def get(session: Session, key_id: str) -> Key | None:
    return session.get(Key, key_id)


def get_locked(session: Session, key_id: str) -> Key | None:
    """The key; where several may write at once, others wait with their claims on its quotas until this session ends."""
    return session.get(Key, key_id, with_for_update=True)


def of_token(session: Session, token: str) -> Key | None:
    """The key with this token, be it expired or not."""
    return session.scalar(OF_TOKEN, {"digest": digest(token)})


def with_tokens(session: Session) -> Sequence[Key]:
    """All keys but the local one, oldest first."""
    return session.scalars(select(Key).where(Key.id != LOCAL_KEY_ID).order_by(Key.id)).all()


def usable(key: Key, moment: datetime) -> bool:
    """Whether a key opens the service at a moment."""
    return key.token_hash is not None and (key.expires_at is None or key.expires_at > moment)


def any_usable(session: Session) -> bool:
    """Whether there is a key that opens the service."""
    return any(usable(key, now()) for key in with_tokens(session))


def used_recently(key: Key) -> bool:
    return key.last_used_at is not None and key.last_used_at > now() - USE_NOTED_EVERY


def note_use(session: Session, key_id: str) -> None:
    session.execute(update(Key).where(Key.id == key_id).values(last_used_at=now()))


def jobs_under_way(session: Session, owner: str) -> int:
    """How many jobs of a key have not ended."""
    return session.scalar(UNDER_WAY, {"owner": owner}) or 0


def unfinished_uploads(session: Session, owner: str) -> int:
    """How many uploads of a key wait for more."""
    waiting = (Upload.owner == owner, Upload.file_id.is_(None), Upload.expires_at > now())
    return session.scalar(select(func.count()).select_from(Upload).where(*waiting)) or 0


def stored_bytes(session: Session, owner: str) -> int:
    """How much a key's files and artifacts take, and its unfinished uploads will."""
    return sum(int(part or 0) for part in session.execute(STORED_BYTES, {"owner": owner}).one())
