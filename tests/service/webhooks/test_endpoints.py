"""Whose endpoints are told."""

from __future__ import annotations

from service.context import Context
from service.keys.schemas import KeyIn
from service.keys.service import create as create_key
from service.tables.keys import LOCAL_KEY_ID
from service.webhooks.repository import enabled, of_owner
from service.webhooks.schemas import WebhookIn
from service.webhooks.service import create


def test_those_of_a_key_are_its_own_and_told_while_they_are_enabled(context: Context) -> None:
    with context.database.write() as session:
        other, _ = create_key(session, KeyIn(name="another"))
        session.flush()
        mine = create(session, LOCAL_KEY_ID, WebhookIn(url="https://me.example/"), [])
        off = create(session, LOCAL_KEY_ID, WebhookIn(url="https://off.example/", enabled=False), [])
        create(session, other.id, WebhookIn(url="https://another.example/"), [])
        session.flush()
        assert [one.id for one in enabled(session, LOCAL_KEY_ID)] == [mine.id]
        assert [one.id for one in of_owner(session, LOCAL_KEY_ID)] == [mine.id, off.id]
