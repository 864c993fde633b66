"""Who may speak to a service that needs no keys."""

from __future__ import annotations

from ipaddress import ip_network

import pytest
from running import Running
from starlette.datastructures import Headers

from service.http.guard import Guard
from service.loopback import is_loopback

PROXY = {"x-forwarded-for": "203.0.113.5"}


def refusal(peer: str = "127.0.0.1", trusted: str = "", path: str = "/", **headers: str) -> str | None:
    networks = [ip_network(trusted)] if trusted else []
    guard = Guard(None, networks)  # type: ignore[arg-type]
    problem = guard.refusal(Headers({name.replace("_", "-"): value for name, value in headers.items()}), peer, path)
    return problem.code if problem else None


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8000", "localhost", "localhost:99", "[::1]:8000", "127.8.9.1", "LOCALHOST"]
)
def test_programs_of_this_machine_are_let_in(host: str) -> None:
    assert refusal(host=host) is None
    assert refusal(host=host, origin=f"http://{host}") is None


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "192.168.1.7:8000", "", "[", "0x7f.1"])
def test_names_that_were_made_to_point_here_are_not(host: str) -> None:
    assert refusal(host=host) == "host_not_allowed"


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "https://127.0.0.1.evil.example", "http://127.0.0.1:9", "http://localhost"],
)
def test_pages_of_other_origins_are_not(origin: str) -> None:
    assert refusal(host="127.0.0.1:8000", origin=origin) == "origin_not_allowed"


def test_only_what_lies_under_the_public_address_is_for_pages_of_any_origin() -> None:
    asked = {"host": "127.0.0.1:8000", "origin": "http://evil.example"}
    assert refusal(**asked, path="/v1/public/abc/file.mp4") is None
    for path in ("/v1/jobs", "/v1/public", "/v1/jobs/v1/public/abc", "/x/v1/public/abc"):
        assert refusal(**asked, path=path) == "origin_not_allowed"


@pytest.mark.parametrize("header", ["x_forwarded_for", "x_forwarded_host", "forwarded", "x_real_ip", "via"])
def test_proxies_are_let_in_only_where_they_are_listed(header: str) -> None:
    asked = {"host": "127.0.0.1:8000", header: "203.0.113.5"}
    assert refusal(**asked) == "proxy_not_trusted"
    assert refusal(trusted="10.0.0.0/8", **asked) == "proxy_not_trusted"
    assert refusal(trusted="127.0.0.1/32", **asked) is None


def test_a_listed_proxy_names_the_host_that_pages_must_come_from() -> None:
    asked = {"host": "127.0.0.1:8000", "x_forwarded_host": "faces.example", "trusted": "127.0.0.0/8"}
    assert refusal(**asked, origin="https://faces.example") is None
    assert refusal(**asked, origin="https://evil.example") == "origin_not_allowed"


def test_only_this_machine_is_loopback() -> None:
    assert all(map(is_loopback, ("127.0.0.1", "127.255.0.3", "::1", "localhost", "a.localhost")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "10.0.0.1", "example.org", "", "127.0.0.1.example.org")))


def test_the_running_service_refuses_them(running: Running) -> None:
    for headers in ({"Host": "evil.example"}, {"Origin": "https://evil.example"}, PROXY):
        response = running.client.get("/v1/jobs", headers=headers)
        assert response.status_code == 403
        assert response.headers["content-type"] == "application/problem+json"
        assert response.headers["x-content-type-options"] == "nosniff"
