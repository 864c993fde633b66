"""What a user of the client gets wrong is told at once, without a request."""

from __future__ import annotations

from pathlib import Path

import pytest

from galatea_client import AsyncClient, Client, GalateaError, InvalidAddress, NotAName, Unreachable
from galatea_client.models import NewWebhook, OwnKey


@pytest.mark.parametrize(
    "address", ["", "127.0.0.1:8000", "localhost", "ftp://host", "http://", "http://host:port", "http://[::1"]
)
def test_a_malformed_address_fails_at_once(address: str) -> None:
    for client in (Client, AsyncClient):
        with pytest.raises(InvalidAddress, match="is no address") as caught:
            client(address)
        assert isinstance(caught.value, GalateaError)


def test_a_text_that_is_a_file_asks_for_a_path(tmp_path: Path) -> None:
    picture = tmp_path / "portrait.jpg"
    picture.write_bytes(b"")
    with Client("http://127.0.0.1:9") as client, pytest.raises(NotAName, match=r"give Path\("):
        client.submit("portrait", {"image": str(picture), "driver": "happy"})


def test_secrets_are_not_shown() -> None:
    assert not OwnKey.model_fields["signing_secret"].repr
    assert not NewWebhook.model_fields["secret"].repr


def test_a_service_that_is_not_there_is_an_error_of_the_same_base() -> None:
    with (
        Client("http://127.0.0.1:9", retries=0) as client,
        pytest.raises(Unreachable, match=r"127\.0\.0\.1:9") as caught,
    ):
        client.kinds()
    assert isinstance(caught.value, GalateaError)
