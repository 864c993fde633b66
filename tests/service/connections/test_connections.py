"""Connections that bring nothing are given up, and do not keep others out; those that come on slowly are not cut."""

from __future__ import annotations

import resource
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest
from raw_http import connect, problem, request, until_closed
from raw_upload import TUS, Media, create, line, standing
from running import Running, eventually

from service.connections.connection_limit import ConnectionLimit, most_connections

Start = Callable[..., Running]
MAX_CONNECTIONS = 20
SHARED = 15
"""Three quarters of them: all that one address gets."""

PARTIAL_HEAD = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Slow: a"


@pytest.fixture(scope="module")
def impatient(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that waits two seconds for anything."""
    bounds = {"head_seconds": 2, "body_seconds": 2, "idle_seconds": 2, "body_bytes_per_second": 500}
    with Running(tmp_path_factory.mktemp("impatient") / "data", worker="false", **bounds) as service:
        yield service


def healthy(running: Running) -> bool:
    """Whether somebody who comes anew is served."""
    answer = until_closed(connect(running, request("GET", "/healthz", Connection="close")))
    return answer.startswith(b"HTTP/1.1 200")


def test_a_head_without_an_end_is_given_up(impatient: Running) -> None:
    silent, begun = connect(impatient), connect(impatient, PARTIAL_HEAD)
    trickling = connect(impatient, PARTIAL_HEAD)
    with pytest.raises(OSError):
        for _ in range(600):  # a byte now and then gains no time
            trickling.sendall(b"a")
            time.sleep(0.1)
    assert problem(until_closed(begun)) == (408, "head_too_slow")
    assert until_closed(silent) == b""


def test_a_connection_that_is_kept_for_later_is_not_kept_for_good(impatient: Running) -> None:
    answer = until_closed(connect(impatient, request("GET", "/healthz")))
    assert answer.startswith(b"HTTP/1.1 200") and answer.endswith(b'{"status":"ok"}')


@pytest.mark.parametrize(
    ("path", "content_type", "begun"),
    [
        ("/v1/files", "multipart/form-data; boundary=b", b'--b\r\nContent-Disposition: form-data; name="file"'),
        ("/v1/jobs", "application/json", b'{"kind": '),
        ("/v1/webhooks", "application/json", b'{"url": '),
    ],
    ids=["a form", "a body that we read", "a body that is read for us"],
)
def test_a_body_that_stands_still_is_given_up(impatient: Running, path: str, content_type: str, begun: bytes) -> None:
    sent = request("POST", path, begun, Content_Type=content_type, Content_Length="1000")
    assert problem(until_closed(connect(impatient, sent))) == (408, "request_stalled")


def test_a_piece_of_an_upload_that_stands_still_is_kept(impatient: Running) -> None:
    media = Media(900_000)
    address = create(impatient, media.size)
    with line(impatient, address, 0, media.size) as stalled:
        stalled.sendall(media.bytes(0, 300_000))
        assert problem(until_closed(stalled.dup())) == (408, "upload_stalled")
    assert standing(impatient, address) == 300_000


def test_a_byte_now_and_then_does_not_hold_a_connection_for_good(impatient: Running) -> None:
    media = Media(900_000)
    with line(impatient, create(impatient, media.size), 0, media.size) as trickling:
        trickling.sendall(media.bytes(0, 100))
        trickling.settimeout(0.2)
        for _ in range(300):
            try:
                answer = trickling.recv(4000)
            except TimeoutError:
                trickling.sendall(b"a")
            else:
                break
        else:
            pytest.fail("it is held on to")
    assert answer.startswith(b"HTTP/1.1 408")


def test_a_slow_body_that_comes_on_is_taken_to_its_end(impatient: Running) -> None:
    """It takes twice as long as a body may stand still."""
    media = Media(40_000)
    address = create(impatient, media.size)
    with line(impatient, address, 0, media.size) as slow:
        for offset in range(0, media.size, 2000):
            slow.sendall(media.bytes(offset, offset + 2000))
            time.sleep(0.2)
        assert slow.recv(4000).startswith(b"HTTP/1.1 204")


def test_who_waits_for_an_answer_is_not_cut_off(impatient: Running, picture: bytes) -> None:
    """A job that nobody works on: its events, and an answer that is held back, outlast every bound."""
    job = impatient.submit(picture)["id"]
    following = connect(impatient, request("GET", f"/v1/jobs/{job}/events"))
    order = b'{"kind": "tiny", "inputs": {"image": "%s"}}' % job_input(impatient, picture)
    waited = connect(impatient, request("POST", "/v1/jobs", order, Content_Type="application/json", Prefer="wait=5"))
    assert waited.recv(4000).startswith(b"HTTP/1.1 202")
    waited.close()
    assert following.recv(4000).startswith(b"HTTP/1.1 200")
    impatient.client.post(f"/v1/jobs/{job}/cancel").raise_for_status()
    assert b"canceled" in until_closed(following)


def job_input(running: Running, picture: bytes) -> bytes:
    sent = running.client.post("/v1/files", files={"file": ("a.png", picture)}).raise_for_status()
    return str(sent.json()["id"]).encode()


def test_connections_that_bring_nothing_make_room_for_others(start: Start) -> None:
    running = start(worker="false", connections=MAX_CONNECTIONS)
    lines = [connect(running, PARTIAL_HEAD if number % 2 else b"") for number in range(3 * MAX_CONNECTIONS)]
    assert all(healthy(running) for _ in range(5))
    told = [line for line in lines if _has_answer(line)]
    assert 3 * MAX_CONNECTIONS - SHARED <= len(told) < 3 * MAX_CONNECTIONS
    for one in told:
        answer = until_closed(one)
        assert problem(answer) == (503, "too_many_connections")
        assert b"retry-after: 5" in answer.lower() and b"connection: close" in answer.lower()
    assert running.output.read_text().count("connections_full") == 1
    for one in lines:
        one.close()


def _has_answer(connection: socket.socket) -> bool:
    connection.settimeout(0.05)
    try:
        return bool(connection.recv(1, socket.MSG_PEEK))
    except TimeoutError:
        return False
    finally:
        connection.settimeout(60)


def test_where_all_are_busy_the_newcomer_is_turned_away(start: Start, picture: bytes) -> None:
    running = start(worker="false", connections=MAX_CONNECTIONS)
    job = running.submit(picture)["id"]
    running.client.close()
    followers = [connect(running, request("GET", f"/v1/jobs/{job}/events")) for _ in range(SHARED)]
    for follower in followers:
        assert follower.recv(4000).startswith(b"HTTP/1.1 200")
    assert problem(until_closed(connect(running, request("GET", "/healthz")))) == (503, "too_many_connections")
    followers.pop().close()
    eventually(lambda: healthy(running), "there is room again")
    for follower in followers:
        assert _is_open(follower)
        follower.close()


def _is_open(connection: socket.socket) -> bool:
    connection.setblocking(False)
    try:
        while connection.recv(65536):
            pass
    except BlockingIOError:
        return True
    return False


class Somebody:
    def __init__(self, address: str):
        self.address = address
        self.gone = False

    def make_room(self) -> None:
        self.gone = True


def test_an_address_that_takes_all_makes_room_for_others_and_for_itself() -> None:
    connection_limit = ConnectionLimit(8)
    greedy = [Somebody("a") for _ in range(6)]
    for one in greedy:
        assert connection_limit.admit(one)
        connection_limit.wait(one)
    others = [Somebody("b"), Somebody("c")]
    for one in others:
        assert connection_limit.admit(one)
        connection_limit.wait(one)
    newcomer = Somebody("d")
    assert connection_limit.admit(newcomer)
    assert [one.gone for one in greedy] == [True] + [False] * 5, "the one that waited longest"
    assert not any(one.gone for one in others)


def test_an_address_that_is_busy_with_its_share_gets_no_more_of_the_others() -> None:
    connection_limit = ConnectionLimit(8)
    assert all(connection_limit.admit(Somebody("a")) for _ in range(6))
    idle = Somebody("b")
    assert connection_limit.admit(idle)
    connection_limit.wait(idle)
    assert not connection_limit.admit(Somebody("a")), "there is room, but not for them"
    assert not idle.gone
    assert connection_limit.admit(Somebody("c"))


def test_files_bound_the_connections() -> None:
    assert most_connections(1000, 1024) == 448
    assert most_connections(1000, 65_536) == 1000


def test_the_service_may_open_as_many_files_as_the_machine_lets_it(start: Start, tmp_path: Path) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(256, hard), hard))
    try:
        running = start(worker="false")
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    assert psutil.Process(running.process.pid).rlimit(psutil.RLIMIT_NOFILE) == (hard, hard)
    assert running.client.options("/v1/uploads", headers=TUS).status_code == 204
