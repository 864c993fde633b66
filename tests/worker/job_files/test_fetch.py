"""Fetching inputs by address, from real servers on this machine: what is taken, what is refused, and with which word."""

from __future__ import annotations

import gzip
import hashlib
import socket
import threading
import time
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from ipaddress import ip_network
from pathlib import Path

import pytest

from service.settings import Settings
from worker.job_files.fetch import FetchFailed, FetchStopped, fetch

MP4 = b"\x00\x00\x00\x18ftypisom\x00\x00\x02\x00isomiso2" + bytes(range(256)) * 400
Answer = Callable[[BaseHTTPRequestHandler], None]


class Host(ThreadingHTTPServer):
    """Answers every request in one way, and counts them."""

    daemon_threads = True

    def __init__(self, answer: Answer, address: str = "127.0.0.1"):
        self.asked: list[str] = []
        host = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                host.asked.append(self.path)
                answer(self)

            def log_message(self, *_: object) -> None:
                """Not to the tests' output."""

        super().__init__((address, 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def url(self, path: str = "/a%20film.mp4?token=s3cret") -> str:
        return f"http://{self.server_address[0]}:{self.server_address[1]}{path}"


@pytest.fixture
def host() -> Iterator[Callable[..., Host]]:
    started: list[Host] = []

    def begin(answer: Answer, address: str = "127.0.0.1") -> Host:
        started.append(Host(answer, address))
        return started[-1]

    yield begin
    for one in started:
        one.shutdown()
        one.server_close()


def gives(content: bytes, status: int = 200, **headers: str) -> Answer:
    def answer(request: BaseHTTPRequestHandler) -> None:
        request.send_response(status)
        given = {name.replace("_", "-"): value for name, value in headers.items()}
        for name, value in ({"Content-Length": str(len(content))} | given).items():
            request.send_header(name, value)
        request.end_headers()
        request.wfile.write(content)

    return answer


def leads_to(url: Callable[[], str], status: int = 302) -> Answer:
    return lambda request: gives(b"", status, Location=url())(request)


def settings(tmp_path: Path, *allowed: str, **more: object) -> Settings:
    networks = [ip_network(network) for network in allowed or ("127.0.0.0/8",)]
    limits = {"image_mb": 1, "video_mb": 1, "disk_reserve_mb": 0}
    return Settings(data_dir=tmp_path, allowed_networks=networks, **(limits | more))


def failure(tmp_path: Path, url: str, *allowed: str, **more: object) -> str:
    with pytest.raises(FetchFailed) as failed:
        fetch(settings(tmp_path, *allowed, **more), url, tmp_path / "x")
    assert "s3cret" not in failed.value.detail, "addresses may hold secrets"
    return failed.value.code


def test_what_lies_at_an_address_is_fetched(tmp_path: Path, host: Callable[..., Host]) -> None:
    seen: list[tuple[int, int | None]] = []
    url = host(gives(MP4, Content_Type="text/plain")).url()
    fetched = fetch(settings(tmp_path), url, tmp_path / "x", lambda *come: seen.append(come))
    assert (fetched.name, fetched.content_type, fetched.size) == ("a film.mp4", "video/mp4", len(MP4))
    assert fetched.path.read_bytes() == MP4 and fetched.sha256 == hashlib.sha256(MP4).hexdigest()
    assert seen[-1] == (len(MP4), len(MP4))


def test_redirects_are_followed(tmp_path: Path, host: Callable[..., Host]) -> None:
    last = host(gives(MP4))
    first = host(leads_to(lambda: last.url("/b.mp4"), 307))
    relative = host(lambda request: (leads_to(lambda: "/there") if request.path == "/here" else gives(MP4))(request))
    assert fetch(settings(tmp_path), first.url(), tmp_path / "x").sha256 == hashlib.sha256(MP4).hexdigest()
    fetch(settings(tmp_path), relative.url("/here"), tmp_path / "y")
    assert relative.asked == ["/here", "/there"]


def test_redirects_into_what_may_not_be_called_are_refused(tmp_path: Path, host: Callable[..., Host]) -> None:
    inner = host(gives(MP4), "127.0.0.1")
    outer = host(leads_to(inner.url), "127.0.0.2")
    assert failure(tmp_path, outer.url(), "127.0.0.2/32") == "input_url_refused"
    for url in ("file:///etc/passwd", "ftp://127.0.0.2/", "http://u:p@127.0.0.2/", "https://169.254.169.254/latest"):
        leading = host(leads_to(lambda url=url: url), "127.0.0.2")
        assert failure(tmp_path, leading.url(), "127.0.0.2/32") == "input_url_refused"
    assert inner.asked == []


def test_redirects_come_to_an_end(tmp_path: Path, host: Callable[..., Host]) -> None:
    circle = host(leads_to(lambda: "/again"))
    assert failure(tmp_path, circle.url()) == "input_url_refused"
    assert len(circle.asked) == 6


def test_private_hosts_are_refused_whatever_their_name(
    tmp_path: Path, host: Callable[..., Host], monkeypatch: pytest.MonkeyPatch
) -> None:
    inner = host(gives(MP4), "127.0.0.1")
    outer = host(gives(MP4), "127.0.0.2")
    answers: dict[str, list[str]] = {"private.example": ["10.0.0.7"], "rebinding.example": ["127.0.0.2", "127.0.0.1"]}
    real = socket.getaddrinfo

    def getaddrinfo(name: str, port: int, *rest: object, **more: object) -> list:
        found = answers.get(name)
        address = name if found is None else found.pop(0) if len(found) > 1 else found[0]
        return real(address, port, type=socket.SOCK_STREAM)

    monkeypatch.setattr(socket, "getaddrinfo", getaddrinfo)
    assert failure(tmp_path, "https://private.example/a.mp4", "127.0.0.2/32") == "input_url_refused"
    url = f"http://rebinding.example:{outer.server_address[1]}/a.mp4"
    fetch(settings(tmp_path, "127.0.0.2/32"), url, tmp_path / "x")
    assert failure(tmp_path, url, "127.0.0.2/32") == "input_url_refused", "the second answer is judged, too"
    assert inner.asked == []


@pytest.mark.parametrize(("status", "content"), [(404, b""), (403, b"no"), (500, b""), (204, b""), (304, b"")])
def test_other_answers_are_no_input(tmp_path: Path, host: Callable[..., Host], status: int, content: bytes) -> None:
    assert failure(tmp_path, host(gives(content, status)).url()) == "input_url_unreachable"


def test_who_does_not_answer_is_unreachable(tmp_path: Path, host: Callable[..., Host]) -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        assert failure(tmp_path, f"http://127.0.0.1:{unused.getsockname()[1]}/") == "input_url_unreachable"
    assert failure(tmp_path, "https://unknown.invalid/") in ("input_url_unreachable", "input_url_timeout")
    assert failure(tmp_path, host(gives(MP4)).url().replace("http:", "https:")) == "input_url_unreachable", "no TLS"
    early = host(gives(MP4[:5000], Content_Length="90000"))
    assert failure(tmp_path, early.url()) == "input_url_unreachable", "the line broke"


def test_what_is_too_large_is_given_up_as_early_as_it_shows(tmp_path: Path, host: Callable[..., Host]) -> None:
    sent = 0

    def endless(request: BaseHTTPRequestHandler) -> None:
        nonlocal sent
        request.send_response(200)
        request.end_headers()
        request.wfile.write(MP4)
        while True:
            sent += request.wfile.write(bytes(100_000))

    assert failure(tmp_path, host(gives(MP4, Content_Length="1000001")).url()) == "input_url_too_large"
    assert failure(tmp_path, host(gives(MP4, Content_Length=str(10**15))).url()) == "input_url_too_large"
    assert failure(tmp_path, host(endless).url()) == "input_url_too_large"
    assert sent < 30_000_000
    picture = b"\x89PNG\r\n\x1a\n" + bytes(600_000)
    assert failure(tmp_path, host(gives(picture)).url(), image_mb=0.5) == "input_url_too_large"


def test_what_takes_too_long_is_given_up(tmp_path: Path, host: Callable[..., Host]) -> None:
    def drip(request: BaseHTTPRequestHandler) -> None:
        request.send_response(200)
        request.end_headers()
        for _ in range(200):
            request.wfile.write(MP4[:1000])
            time.sleep(0.1)

    def silent(request: BaseHTTPRequestHandler) -> None:
        time.sleep(10)

    for answer in (drip, silent):
        assert failure(tmp_path, host(answer).url(), fetch_seconds=1) == "input_url_timeout"


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"<html>please sign in</html>" * 1000, "media_type_unsupported"),
        (b"ID3" + bytes(9000), "media_type_unsupported"),
        (b"short", "media_type_unsupported"),
        (b"", "file_empty"),
    ],
)
def test_what_is_no_picture_or_video_is_refused(
    tmp_path: Path, host: Callable[..., Host], content: bytes, code: str
) -> None:
    assert failure(tmp_path, host(gives(content, Content_Type="video/mp4")).url()) == code


def test_nothing_is_expanded(tmp_path: Path, host: Callable[..., Host]) -> None:
    bomb = gzip.compress(MP4 + bytes(5_000_000))
    fetched = fetch(settings(tmp_path), host(gives(bomb, Content_Encoding="gzip")).url(), tmp_path / "x")
    assert (fetched.content_type, fetched.size) == ("application/gzip", len(bomb)), "an archive, as it came"


def test_it_stops_when_it_is_told_to(tmp_path: Path, host: Callable[..., Host]) -> None:
    def slow(request: BaseHTTPRequestHandler) -> None:
        request.send_response(200)
        request.end_headers()
        for _ in range(200):
            request.wfile.write(MP4)
            time.sleep(0.05)

    with pytest.raises(FetchStopped):
        fetch(settings(tmp_path, video_mb=100), host(slow).url(), tmp_path / "x", stopped=lambda: True)


def test_a_full_disk_is_no_place_for_it(tmp_path: Path, host: Callable[..., Host]) -> None:
    assert failure(tmp_path, host(gives(MP4)).url(), disk_reserve_mb=10**9) == "disk_full"
