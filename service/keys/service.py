"""Making and revoking keys, and erasing what belongs to one."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import timedelta

from sqlalchemy.orm import Session

from service.auth import repository
from service.auth.tokens import KEY_HINT_CHARACTERS, digest, new_link_secret, new_signing_secret, new_token
from service.clock import now
from service.context import Context
from service.files import repository as files
from service.files.service import forget
from service.ids import new_id
from service.job_records import jobs
from service.jobs.service import delete as delete_job
from service.keys.schemas import KeyIn
from service.libraries import repository as kept
from service.libraries.library import LIBRARIES
from service.links import repository as links
from service.problems import Problem
from service.tables.keys import LOCAL_KEY_ID, Key
from service.uploads import repository as uploads
from service.uploads import spool
from service.webhooks import repository as webhooks


def create(session: Session, requested: KeyIn) -> tuple[Key, str]:
    """Make a key. Returns it with its token, which cannot be had again."""
    token = new_token()
    moment = now()
    key = Key(
        id=new_id(),
        name=requested.name,
        token_hash=digest(token),
        hint=token[:KEY_HINT_CHARACTERS],
        scopes=list(requested.scopes),
        signing_secret=new_signing_secret(),
        link_secret=new_link_secret(),
        requests_per_minute=requested.requests_per_minute,
        jobs_at_once=requested.jobs_at_once,
        stored_mb=requested.stored_mb,
        created_at=moment,
        expires_at=None if requested.expires_in_days is None else moment + timedelta(days=requested.expires_in_days),
    )
    session.add(key)
    return key, token


def revoke(session: Session, key_id: str) -> Key:
    """Make a key's token, its sessions, its signed links and its public ones worthless.

    Raises a 404 problem if there is no such key. What belongs to it stays; its jobs go on.
    """
    key = repository.get(session, key_id)
    if key is None or key.id == LOCAL_KEY_ID:
        raise Problem(404, "key_not_found", "There is no such key.")
    if key.revoked_at is None:
        key.token_hash, key.link_secret, key.revoked_at = None, new_link_secret(), now()
        links.revoke_all(session, key.id)
    return key


def erase_all(context: Context, owner: str) -> None:
    """Erase everything that belongs to a key: its jobs (running ones stop), drivers, motions, files, uploads
    and webhooks."""
    while job_ids := _some_jobs(context, owner):
        for job_id in job_ids:
            delete_job(context, owner, job_id)
    with context.database.write() as session:
        for library in LIBRARIES.values():
            kept.erase_all(session, library, owner)
        webhooks.erase_all(session, owner)
        erased = files.erase_unused(session, owner=owner)
        given_up = uploads.erase_all(session, owner)
    forget(context, erased)
    for upload_id in given_up:
        spool.path(context.settings, upload_id).unlink(missing_ok=True)


def _some_jobs(context: Context, owner: str) -> Sequence[str]:
    with context.database.read() as session:
        return [job.id for job in jobs.page(session, owner, limit=100)]
