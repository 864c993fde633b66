"""A session of the page is its key's, for its time, until the key is revoked."""

from __future__ import annotations

import time

import pytest

from service.auth.sessions import SESSION_SECONDS, key_of_session, new_session
from service.auth.tokens import signature
from service.clock import now
from service.context import Context
from service.tables.keys import Key
from service.vault import Secret


@pytest.fixture
def key(context: Context) -> Key:
    with context.database.write() as session:
        made = Key(
            **{"id": "mine", "name": "mine", "token_hash": "hash", "hint": "", "scopes": ["read"]},
            **{"signing_secret": Secret("a"), "link_secret": Secret("b"), "created_at": now()},
        )
        session.add(made)
    return made


def opens(context: Context, cookie: str) -> str | None:
    """The id of the key that a cookie stands for."""
    with context.database.read() as session:
        found = key_of_session(session, cookie)
    return found.id if found is not None else None


def test_a_cookie_stands_for_its_key_and_names_its_end(context: Context, key: Key) -> None:
    cookie = new_session(key)
    assert opens(context, cookie) == "mine"
    assert abs(int(cookie.split(".")[1]) - time.time() - SESSION_SECONDS) < 60


def test_it_ends_with_its_time_and_with_its_key(context: Context, key: Key) -> None:
    past = str(int(time.time()) - 1)
    assert opens(context, f"mine.{past}.{signature('b', 'session', 'mine', past)}") is None
    cookie = new_session(key)
    with context.database.write() as session:
        session.get_one(Key, "mine").token_hash = None
    assert opens(context, cookie) is None


def test_what_was_signed_for_anything_else_opens_nothing(context: Context, key: Key) -> None:
    later = str(int(time.time()) + 100)
    _, expires, given = new_session(key).split(".")
    for cookie in (
        *("", "mine", "mine..", f"mine.{expires}.", f"nobody.{expires}.{given}", f"mine.{later}.{given}"),
        *(f"mine.{expires}.{given}x", f"mine.\u0661{expires}.{given}", f"mine.{'9' * 20}.{given}"),
        f"mine.{later}.{signature('b', 'artifact', 'mine', later)}",
    ):
        assert opens(context, cookie) is None, cookie
