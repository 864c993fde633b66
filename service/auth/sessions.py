"""Sessions of the web page: a key is given once, then a cookie that scripts cannot read stands for it.

The cookie holds the key's id and an expiry, signed with the key's own secret: nothing is stored for it, and it
ends with the key. Browsers send it to this origin alone (`SameSite=Strict`).
"""

from __future__ import annotations

import time

from sqlalchemy.orm import Session

from service.auth import repository
from service.auth.tokens import signature, signed_by
from service.tables.keys import Key

SESSION_COOKIE = "galatea_session"
SESSION_SECONDS = 12 * 3600


def new_session(key: Key) -> str:
    """The cookie's value for a key."""
    expires = str(int(time.time()) + SESSION_SECONDS)
    return f"{key.id}.{expires}.{signature(key.link_secret.reveal(), 'session', key.id, expires)}"


def key_of_session(session: Session, value: str) -> Key | None:
    """The key that a cookie stands for; None if it is no valid one (any more)."""
    key_id, _, rest = value.partition(".")
    expires, _, given = rest.partition(".")
    if not (expires.isascii() and expires.isdigit() and len(expires) < 12) or int(expires) < time.time():
        return None
    key = repository.get(session, key_id)
    if (
        key is None
        or key.token_hash is None
        or not signed_by(key.link_secret.reveal(), given, "session", key_id, expires)
    ):
        return None
    return key
