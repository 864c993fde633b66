"""Calls to other hosts: which addresses may be called, and that only those are."""

from __future__ import annotations

import socket
import ssl
import subprocess
import time
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler
from ipaddress import ip_address, ip_network
from pathlib import Path

import httpx
import pytest
from receiver import Receiver, status

from service.outbound.address import AddressRefused, is_public, may_call, require_callable, resolve
from service.outbound.client import client
from service.settings import Settings

Names = dict[str, list[list[str]]]


@pytest.mark.parametrize("address", ["8.8.8.8", "1.1.1.1", "2606:4700::1111"])
def test_public_addresses(address: str) -> None:
    assert is_public(ip_address(address))


@pytest.mark.parametrize(
    "address",
    [
        *("127.0.0.1", "127.255.255.254", "0.0.0.0", "0.1.2.3", "10.0.0.1", "172.16.0.1", "172.31.255.255"),
        *("192.168.0.1", "169.254.169.254", "100.64.0.1", "100.127.255.255", "192.0.0.1", "192.0.2.1"),
        *("198.18.0.1", "198.51.100.1", "203.0.113.1", "224.0.0.1", "239.255.255.250", "240.0.0.1"),
        *("255.255.255.255", "192.88.99.1"),
        *("::", "::1", "::7f00:1", "::ffff:127.0.0.1", "::ffff:8.8.8.8", "::ffff:0:8.8.8.8", "64:ff9b::808:808"),
        *("64:ff9b:1::808:808", "fe80::1", "fe80::1%2", "fec0::1", "fc00::1", "fd00:ec2::254", "ff02::1", "ff0e::1"),
        *("2001:db8::1", "2001::1", "2002:7f00:1::1", "3fff::1", "100::1", "5f00::1"),
    ],
)
def test_all_others_are_refused_unless_their_network_is_allowed(address: str) -> None:
    parsed = ip_address(address)
    assert not is_public(parsed)
    assert not may_call(parsed, [], encrypted=True)
    assert may_call(parsed, [ip_network(address.partition("%")[0])], encrypted=False)


def test_public_addresses_are_called_by_tls_only() -> None:
    assert may_call(ip_address("8.8.8.8"), [], encrypted=True)
    assert not may_call(ip_address("8.8.8.8"), [ip_network("10.0.0.0/8")], encrypted=False)


@pytest.mark.parametrize(
    "url",
    [
        *("https://127.0.0.1/", "https://127.1/", "https://0x7f000001/", "https://2130706433/", "https://0177.0.0.1/"),
        *("https://localhost:8000/x", "https://a.localhost/", "https://[::1]/", "https://[::ffff:10.0.0.1]/"),
        *("https://169.254.169.254/latest", "http://example.com/", "http://8.8.8.8/", "ftp://example.com/"),
        *(
            "https://",
            "//example.com",
            "example.com",
            "",
            "https://u:p@example.com/",
            "https://[",
            "file:///etc/passwd",
        ),
        "https://example.com/" + "x" * 2000,
    ],
)
def test_what_can_be_seen_to_lead_nowhere_is_refused_at_once(url: str) -> None:
    with pytest.raises(AddressRefused):
        require_callable(url, [])


def test_what_may_lead_somewhere_is_not() -> None:
    require_callable("https://example.com:8443/hook?a=b", [])
    require_callable("https://8.8.8.8/", [])
    require_callable("http://127.0.0.1:8000/", [ip_network("127.0.0.0/8")])
    require_callable("http://receiver.lan/", [ip_network("10.0.0.0/8")])


def caller(*allowed: str, seconds: float = 5, **options: object) -> httpx.Client:
    settings = Settings(allowed_networks=[ip_network(network) for network in allowed])
    return client(settings, connect_seconds=2, seconds=seconds, **options)


def test_a_name_is_looked_up_once_and_its_checked_address_is_called(
    receive: Callable[..., Receiver], names: Names
) -> None:
    """A resolver that answers with an allowed address first and with a forbidden one from then on gains nothing."""
    good = receive("127.0.0.2")
    names["rebinding.example"] = [["127.0.0.2"], ["127.0.0.1"]]
    with caller("127.0.0.2/32") as http:
        answer = http.get(f"http://rebinding.example:{good.port}/")
        assert answer.text == "ok"
        with pytest.raises(AddressRefused, match=r"leads to a private network.*GALATEA_ALLOWED_NETWORKS") as refused:
            http.get(f"http://rebinding.example:{good.port}/")
    assert "127.0.0.1" not in str(refused.value), "where a name of the inner network leads is the operator's to know"
    assert [call.headers["host"] for call in good.calls] == [f"rebinding.example:{good.port}"], (
        "Host carries the name, not the address"
    )


def test_of_several_addresses_only_those_that_may_be_called_are(receive: Callable[..., Receiver], names: Names) -> None:
    bad = receive("127.0.0.1")
    names["mixed.example"] = [["127.0.0.1", "::1", "127.0.0.2", "127.0.0.3"]]
    assert resolve("mixed.example", 80, [ip_network("127.0.0.2/31")], False) == ["127.0.0.2", "127.0.0.3"]
    with caller("127.0.0.2/31") as http, pytest.raises(httpx.ConnectError):
        http.get(f"http://mixed.example:{bad.port}/")
    assert bad.calls == []


def test_the_next_address_is_tried_where_one_does_not_answer(receive: Callable[..., Receiver], names: Names) -> None:
    good = receive("127.0.0.3")
    names["two.example"] = [["127.0.0.2", "127.0.0.3"]]
    with caller("127.0.0.0/8") as http:
        assert http.get(f"http://two.example:{good.port}/").text == "ok"


def test_redirects_are_judged_again(receive: Callable[..., Receiver]) -> None:
    inner = receive("127.0.0.1")

    outer = receive("127.0.0.2", status(302, Location=inner.url))
    with caller("127.0.0.2/32") as http:
        assert http.get(f"http://127.0.0.2:{outer.port}/").status_code == 302, "nobody follows unasked"
        with pytest.raises(AddressRefused):
            http.get(f"http://127.0.0.2:{outer.port}/", follow_redirects=True)
    assert inner.calls == []


def test_a_proxy_of_the_environment_is_not_asked(
    receive: Callable[..., Receiver], monkeypatch: pytest.MonkeyPatch
) -> None:
    proxy, good = receive(), receive()
    for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY"):
        monkeypatch.setenv(name, f"http://127.0.0.1:{proxy.port}")
    with caller("127.0.0.0/8") as http:
        http.get(f"http://127.0.0.1:{good.port}/")
    assert (len(proxy.calls), len(good.calls)) == (0, 1)


def test_nothing_is_kept_from_one_call_to_the_next(receive: Callable[..., Receiver]) -> None:
    receiver = receive(answer=status(200, Set_Cookie="mark=1; Path=/"))
    with caller("127.0.0.0/8") as http:
        for _ in range(2):
            http.get(receiver.url)
    assert all("cookie" not in call.headers for call in receiver.calls)


def test_an_answer_that_drips_is_given_up(receive: Callable[..., Receiver]) -> None:
    """Each piece comes soon enough; all of them together do not."""

    def drip(request: BaseHTTPRequestHandler) -> None:
        request.send_response(200)
        request.end_headers()
        for _ in range(300):
            request.wfile.write(b"x")
            time.sleep(0.1)

    slow = receive(answer=drip)
    with caller("127.0.0.0/8", seconds=1) as http, pytest.raises(httpx.ReadTimeout):
        http.get(f"http://127.0.0.1:{slow.port}/")


def test_a_resolver_that_does_not_answer_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: time.sleep(30))
    with caller(seconds=0.5) as http, pytest.raises(httpx.ConnectTimeout):
        http.get("https://slow.example/")


@pytest.mark.parametrize("host", ["unknown.invalid", "a" * 64 + ".example"])
def test_a_name_that_nobody_knows_is_an_error_of_the_connection(host: str) -> None:
    with caller(seconds=20) as http, pytest.raises((httpx.ConnectError, httpx.ConnectTimeout)):
        http.get(f"https://{host}/")


@pytest.fixture
def authority(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A certificate for hooks.example, which counts as an authority while the test runs, and its key in one file."""
    both = tmp_path / "hooks.pem"
    subprocess.run(
        [
            *("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=hooks.example"),
            *("-addext", "subjectAltName=DNS:hooks.example", "-keyout", "key.pem", "-out", "certificate.pem"),
        ],
        cwd=tmp_path,
        check=True,
        capture_output=True,
    )
    both.write_text((tmp_path / "key.pem").read_text() + (tmp_path / "certificate.pem").read_text())
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "certificate.pem"))
    return both


def test_the_name_stands_in_the_handshake_and_the_certificate_is_held_against_it(
    receive: Callable[..., Receiver], names: Names, authority: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    receiver, asked = receive(), []
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(authority)
    context.sni_callback = lambda _, name, __: asked.append(name)
    receiver.socket = context.wrap_socket(receiver.socket, server_side=True)
    names["hooks.example"] = names["other.example"] = [["127.0.0.1"]]
    with caller("127.0.0.0/8") as http:
        assert http.get(f"https://hooks.example:{receiver.port}/").text == "ok"
        with pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
            http.get(f"https://other.example:{receiver.port}/")
    monkeypatch.delenv("SSL_CERT_FILE")
    with caller("127.0.0.0/8") as http, pytest.raises(httpx.ConnectError, match="CERTIFICATE_VERIFY_FAILED"):
        http.get(f"https://hooks.example:{receiver.port}/")
    assert asked == ["hooks.example", "other.example", "hooks.example"]
