"""Where a request comes from, as wrong keys are counted by it: what nobody vouches for is not believed."""

from __future__ import annotations

from ipaddress import ip_network

import pytest
from starlette.requests import Request

from service.auth.wrong_keys import caller_address

PROXIES = [ip_network("10.0.0.0/8"), ip_network("fd00::/8")]


def request(client: str, forwarded: str | None = None) -> Request:
    headers = [] if forwarded is None else [(b"x-forwarded-for", forwarded.encode())]
    return Request({"type": "http", "client": (client, 1), "headers": headers})


@pytest.mark.parametrize(
    ("client", "forwarded", "expected"),
    [
        ("192.0.2.7", None, "192.0.2.7"),
        ("192.0.2.7", "203.0.113.9", "192.0.2.7"),
        ("10.0.0.1", "203.0.113.9", "203.0.113.9"),
        ("10.0.0.1", "198.51.100.1, 203.0.113.9, 10.2.0.1", "203.0.113.9"),
        ("10.0.0.1", "198.51.100.1, no address, 10.2.0.1", "10.2.0.1"),
        ("10.0.0.1", None, "10.0.0.1"),
        ("2001:db8:1:2:3:4:5:6", None, "2001:db8:1:2::/64"),
        ("2001:db8:1:2:ffff::1", None, "2001:db8:1:2::/64"),
        ("fd00::1", "2001:db8:9::1", "2001:db8:9::/64"),
    ],
)
def test_it_is_the_last_address_that_is_no_trusted_proxy_s(client: str, forwarded: str | None, expected: str) -> None:
    assert caller_address(request(client, forwarded), PROXIES) == expected
