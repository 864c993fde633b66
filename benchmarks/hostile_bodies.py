"""What strangers can do to a service by what they send: every request of `benchmarks.service_figures.strangers`, one after the other,
while somebody else asks `/healthz` again and again.

    python -m benchmarks.hostile_bodies

A real `galatea serve` runs in processes of its own over an empty folder. Printed are how many requests were sent, how
they were answered, how often by 500, and how long the other one waited at most.
"""

from __future__ import annotations

import argparse
import http.client
import multiprocessing
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from urllib.parse import urlsplit

from benchmarks.presentation.tables import machine, table
from benchmarks.service import service
from benchmarks.service_figures.strangers import Sent, strangers

HEALTH_CHECK_SECONDS = 0.02
BODY_PATIENCE_SECONDS = 300.0


@dataclass
class Outcome:
    """How the requests ended: answers by status and code, (seconds, request) of the longest waits of the other one,
    bytes of the longest answer."""

    answers: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    waits: list[tuple[float, str]] = field(default_factory=list)
    longest_answer: tuple[int, str] = (0, "")


def send(address: str, token: str, one: Sent) -> tuple[int, bytes]:
    """The answer's status and body; 0 where the line was cut without an answer. No key is sent where `token` is empty."""
    place = urlsplit(address)
    connection = http.client.HTTPConnection(place.hostname or "", place.port, timeout=BODY_PATIENCE_SECONDS)
    try:
        connection.putrequest(one.method, one.path, skip_accept_encoding=True)
        key = {"Authorization": f"Bearer {token}"} if token else {}
        for name, value in (key | one.headers).items():
            connection.putheader(name, value.encode("latin-1"))
        if one.chunked:
            connection.putheader("Transfer-Encoding", "chunked")
        elif one.pieces:
            connection.putheader("Content-Length", str(sum(map(len, one.pieces))))
        connection.endheaders()
        try:
            if one.chunked:
                framed = [b"%x\r\n%s\r\n" % (len(piece), piece) for piece in one.pieces]
                connection.send(b"".join([*framed, b"0\r\n\r\n"]))
            else:
                connection.send(b"".join(one.pieces))
        except OSError:
            pass  # it was refused before all had been sent: the answer is there
        answer = connection.getresponse()
        return answer.status, answer.read()
    except (OSError, http.client.HTTPException):
        return 0, b""
    finally:
        connection.close()


def watch(address: str, orders: Connection) -> None:
    """Ask `/healthz` again and again; for each order, answer how long the longest wait since the last one was."""
    place = urlsplit(address)
    longest = 0.0
    while True:
        began = time.monotonic()
        connection = http.client.HTTPConnection(place.hostname or "", place.port, timeout=BODY_PATIENCE_SECONDS)
        try:
            connection.request("GET", "/healthz")
            connection.getresponse().read()
        except (OSError, http.client.HTTPException):
            pass
        finally:
            connection.close()
        longest = max(longest, time.monotonic() - began)
        while orders.poll(HEALTH_CHECK_SECONDS):
            if orders.recv() is None:
                return
            orders.send(longest)
            longest = 0.0


@contextmanager
def watched(address: str) -> Iterator[Connection]:
    """Somebody else, in a process of their own."""
    here, there = multiprocessing.get_context("spawn").Pipe()
    other = multiprocessing.get_context("spawn").Process(target=watch, args=(address, there), daemon=True)
    other.start()
    try:
        here.send(True)
        here.recv()
        yield here
    finally:
        here.send(None)
        other.join(BODY_PATIENCE_SECONDS)


def schedule(address: str, token: str, requests: Iterable[Sent]) -> Outcome:
    """Send them all."""
    met = Outcome()
    with watched(address) as other:
        for one in requests:
            status, body = send(address, token, one)
            met.answers[str(status)] += 1
            if status >= 500:
                met.faults.append(one.what)
            met.longest_answer = max(met.longest_answer, (len(body), one.what))
            other.send(True)
            met.waits.append((other.recv(), one.what))
    return met


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="send those alone whose name holds this")
    asked = parser.parse_args()
    requests = [one for one in strangers() if asked.only in one.what]
    with service(1, 100) as (address, tokens, _):
        quiet = schedule(address, tokens[0], [Sent("nothing", "GET", "/healthz")] * 50)
        began = time.monotonic()
        met = schedule(address, tokens[0], requests)
        seconds = time.monotonic() - began
    print(machine())
    waits = sorted(met.waits, reverse=True)
    figures: list[list[object]] = [
        ["requests", sum(met.answers.values())], ["seconds", f"{seconds:.0f}"], ["answered by 500", len(met.faults)],
        ["cut without an answer", met.answers["0"]],
        ["longest wait of the other one, s", f"{waits[0][0]:.2f}"],
        ["the same while nothing is sent, s", f"{max(quiet.waits)[0]:.2f}"],
        ["requests during which it waited longer than 0.2 s", sum(wait > 0.2 for wait, _ in waits)],
        ["longest answer, bytes", met.longest_answer[0]],
    ]  # fmt: skip
    print(table("What strangers send", ["", ""], figures))
    print(table("Answers", ["status", "count"], [list(one) for one in sorted(met.answers.items())]))
    print(table("Longest waits", ["s", "during"], [[f"{wait:.2f}", what[:80]] for wait, what in waits[:15]]))
    print(table("Answered by 500", ["request"], [[what[:100]] for what in met.faults]))
    print("longest answer:", met.longest_answer)


if __name__ == "__main__":
    main()
