"""Secrets in the database, with and without keys that encrypt them, on both databases."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from contextlib import contextmanager
from datetime import timedelta
from ipaddress import ip_network
from pathlib import Path

import pytest
import standardwebhooks
from receiver import Receiver
from sqlalchemy import create_engine, select, text

from service.context import Context
from service.database import postgresql
from service.settings import Settings
from service.tables.keys import LOCAL_KEY_ID, Key
from service.tables.webhooks import Delivery, Webhook
from service.vault import ENCRYPTED_PREFIX, SecretUnreadable, new_key
from service.webhooks import repository, service
from service.webhooks.schemas import WebhookIn
from worker.periodic.webhook_sender import WebhookSender

LOOPBACK = [ip_network("127.0.0.0/8")]
COLUMNS = (("keys", "signing_secret"), ("keys", "link_secret"), ("webhooks", "secret"), ("webhooks", "previous_secret"))
Opened = Callable[..., Context]


@pytest.fixture
def opened(tmp_path: Path, database_url: str) -> Callable[..., object]:
    """`with opened(KEY, ...) as context` is the service's parts over one database, with these keys for secrets."""

    @contextmanager
    def open_with(*keys: str) -> Iterator[Context]:
        given = {"data_dir": tmp_path, "database_url": database_url, "kinds": [], "disk_reserve_mb": 0}
        context = Context.open(Settings(**given, allowed_networks=LOOPBACK, secrets_key=",".join(keys)))
        yield context
        context.close()

    return open_with


def stored(url: str) -> list[str]:
    """All secrets as they stand in the tables."""
    place, arguments = postgresql.address(url) if postgresql.is_postgresql_url(url) else (url, {})
    with create_engine(place, connect_args=arguments).begin() as connection:
        rows = [connection.scalars(text(f"SELECT {column} FROM {table}")).all() for table, column in COLUMNS]
    return [secret for row in rows for secret in row if secret is not None]


def endpoint(context: Context, url: str = "http://127.0.0.1:9/") -> Webhook:
    """An endpoint with two secrets that sign."""
    with context.database.write() as session:
        made = service.create(session, LOCAL_KEY_ID, WebhookIn(url=url), LOOPBACK)
        session.flush()
        return service.rotate(session, LOCAL_KEY_ID, made.id, timedelta(hours=1))


def secrets(context: Context, webhook_id: str) -> list[str]:
    """All secrets as they are."""
    with context.database.read() as session:
        key, webhook = session.get_one(Key, LOCAL_KEY_ID), session.get_one(Webhook, webhook_id)
        assert webhook.previous_secret is not None
        four = (key.signing_secret, key.link_secret, webhook.secret, webhook.previous_secret)
        return [secret.reveal() for secret in four]


def deliver(context: Context, webhook_id: str) -> Delivery:
    """Send the endpoint a test; what became of it."""
    with context.database.write() as session:
        message = service.test(session, LOCAL_KEY_ID, webhook_id)
    sender = WebhookSender(context)
    wait(sender.look())
    sender.close()
    with context.database.read() as session:
        return session.scalars(select(Delivery).where(Delivery.id == message.id)).one()


def assert_sealed(folder: Path, url: str, clear: list[str]) -> None:
    assert len(stored(url)) == 4 and all(secret.startswith(ENCRYPTED_PREFIX) for secret in stored(url))
    for path in (path for path in folder.rglob("*") if path.is_file()):  # SQLite's file, and its log
        content = path.read_bytes()
        assert not [secret for secret in clear if secret.encode() in content], path


def test_without_a_key_secrets_are_kept_as_they_are(opened: Opened, database_url: str) -> None:
    with opened() as context:
        clear = secrets(context, endpoint(context).id)
    assert sorted(stored(database_url)) == sorted(clear)


def test_what_was_in_clear_is_encrypted_at_the_next_start_and_signs_as_before(
    opened: Opened, database_url: str, tmp_path: Path, receive: Callable[..., Receiver]
) -> None:
    receiver = receive()
    with opened() as context:
        webhook = endpoint(context, receiver.url)
        clear = secrets(context, webhook.id)
    with opened(new_key()) as context:
        assert_sealed(tmp_path, database_url, clear)
        assert secrets(context, webhook.id) == clear
        assert deliver(context, webhook.id).status == "delivered"
        (call,) = receiver.calls
        for secret in clear[2:]:
            standardwebhooks.Webhook(secret).verify(call.body, call.headers)
        with context.database.write() as session:  # what is made from now on is encrypted at once
            new = service.rotate(session, LOCAL_KEY_ID, webhook.id, timedelta(hours=1)).secret.reveal()
        assert_sealed(tmp_path, database_url, [*clear, new])


def test_keys_are_replaced_by_putting_a_new_one_first(opened: Opened, database_url: str) -> None:
    old, new = new_key(), new_key()
    with opened(old) as context:
        webhook = endpoint(context)
        clear, before = secrets(context, webhook.id), stored(database_url)
    with opened(old):
        assert stored(database_url) == before, "what is under the first key stays as it is"
    with opened(new, old) as context:
        assert secrets(context, webhook.id) == clear
    with opened(new) as context:
        assert secrets(context, webhook.id) == clear


@pytest.mark.parametrize("keys", [(), (new_key(),)], ids=["no key", "another key"])
def test_what_no_key_opens_fails_with_a_reason_until_the_key_is_back(
    opened: Opened, database_url: str, receive: Callable[..., Receiver], keys: tuple[str, ...]
) -> None:
    right, receiver = new_key(), receive()
    with opened(right) as context:
        webhook = endpoint(context, receiver.url)
        before = stored(database_url)
    with opened(*keys) as context:
        assert stored(database_url) == before, "nothing is lost"
        delivery = deliver(context, webhook.id)
        with context.database.read() as session:
            (attempt,) = repository.attempts(session, [delivery.id])[delivery.id]
            assert session.get_one(Webhook, webhook.id).failing_since is None, "it is no fault of the receiver's"
        assert (attempt.error_code, attempt.response_status) == ("secret_unreadable", None)
        assert "GALATEA_SECRETS_KEY" in (attempt.error_detail or "")
        assert delivery.status == "pending" and receiver.calls == []
        with pytest.raises(SecretUnreadable):
            secrets(context, webhook.id)
    with opened(right) as context:
        assert deliver(context, webhook.id).status == "delivered"


def test_going_down_gives_the_older_release_its_secrets_in_clear(opened: Opened, database_url: str) -> None:
    with opened(new_key()) as context:
        clear = secrets(context, endpoint(context).id)
        context.database.migrate("0014", forget=True)
        assert sorted(stored(database_url)) == sorted(clear)


def test_a_key_that_is_none_is_refused_and_the_shell_makes_a_good_one(tmp_path: Path) -> None:
    def galatea(*arguments: str, key: str) -> subprocess.CompletedProcess[str]:
        environment = os.environ | {"GALATEA_DATA_DIR": str(tmp_path), "GALATEA_SECRETS_KEY": key}
        command = [sys.executable, "-m", "shell.main", *arguments]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    refused = galatea("serve", "--port", "0", key=f"{new_key()},hunter2")
    assert refused.returncode != 0 and "hunter2" not in refused.stderr
    assert "GALATEA_SECRETS_KEY: " in refused.stderr and "galatea keys secrets-key" in refused.stderr
    made = galatea("keys", "secrets-key", key="").stdout.strip()
    Settings(secrets_key=made)
