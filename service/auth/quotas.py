"""How much a key may have at once: jobs under way, unfinished uploads, and bytes stored."""

from __future__ import annotations

from sqlalchemy.orm import Session

from service.auth import repository
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE, Settings
from service.tables.keys import LOCAL_KEY_ID, Key

QUOTA_RETRY_SECONDS = 5


def require_job(session: Session, settings: Settings, owner: str, beside: int = 0) -> None:
    """Raise a 429 problem if a key may not have one more job under way, `beside` what else of it is. To be asked where the
    job is written, so that two requests at the same moment cannot both be the last."""
    most = _limits(session, settings, owner).jobs_at_once
    if most is not None and repository.jobs_under_way(session, owner) + beside >= most:
        raise Problem(
            429,
            "too_many_jobs",
            f"The key may have {most} jobs under way: wait until one of them has ended.",
            headers={"Retry-After": str(QUOTA_RETRY_SECONDS)},
        )


def require_upload(session: Session, settings: Settings, owner: str) -> None:
    """Raise a 429 problem if a key may not begin one more upload. To be asked where the upload is written."""
    most = _limits(session, settings, owner).uploads_at_once
    if most is not None and repository.unfinished_uploads(session, owner) >= most:
        raise Problem(
            429,
            "too_many_uploads",
            f"The key may have {most} unfinished uploads: finish one of them, or end it by DELETE.",
            headers={"Retry-After": str(QUOTA_RETRY_SECONDS)},
        )


def require_room(session: Session, settings: Settings, owner: str, more_bytes: int) -> None:
    """Raise a 507 problem if a key may not store that many more bytes."""
    most = _limits(session, settings, owner).stored_mb
    if most is not None and repository.stored_bytes(session, owner) + more_bytes > most * BYTES_PER_MEGABYTE:
        raise Problem(
            507,
            "storage_quota",
            f"The key may store {most} MB, and this would be more: delete jobs, files or drivers that are not needed.",
        )


class Limits:
    """A key's own limits, and those of the settings where it has none. The local key has only its own."""

    def __init__(self, key: Key, settings: Settings):
        bounded = key.id != LOCAL_KEY_ID
        self.requests_per_minute = key.requests_per_minute or (settings.requests_per_minute if bounded else None)
        self.jobs_at_once = settings.jobs_at_once if key.jobs_at_once is None and bounded else key.jobs_at_once
        self.uploads_at_once = settings.uploads_at_once if bounded else None
        self.stored_mb = settings.stored_mb if key.stored_mb is None and bounded else key.stored_mb


def _limits(session: Session, settings: Settings, owner: str) -> Limits:
    key = repository.get_locked(session, owner)
    if key is None:
        raise LookupError(f"no key {owner}")
    return Limits(key, settings)
