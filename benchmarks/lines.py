"""How the service bears lines that bring nothing: half-open ones, heads and bodies that never end, many who only follow.

    python -m benchmarks.lines --seconds 30 --files 1024

A real `galatea serve` runs in processes of its own over an empty folder, with as many file descriptors as a login gives
(`--files`). Every schedule opens its lines within a few seconds and leaves them; a client that behaves well asks
`/healthz` meanwhile, over a new line each time.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import psutil
import uvloop
from httpx import URL

from benchmarks.presentation.tables import machine, table
from benchmarks.service import ROOT, portrait

OPENING_SECONDS = 5.0
ASKING_SECONDS = 0.2
LOCKED_AFTER_SECONDS = 15.0
"""After this long without an answer the service counts as locked."""

SLOW_HEAD = b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "
SLOW_BODY = (
    b"POST /v1/files HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000000\r\n"
    b"Content-Type: multipart/form-data; boundary=b\r\n\r\n"
    b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.png"\r\n\r\n\x89PNG\r\n\x1a\n'
)
FOLLOW_REQUEST = "GET /v1/jobs/{job}/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


@dataclass
class Observed:
    """What came of the lines of one schedule, and of the client that behaves well."""

    asked: int = 0
    open: int = 0
    most: int = 0
    answers: Counter[str] = field(default_factory=Counter)
    """By status; `refused` where there was no line at all, `closed` where one ended without a word."""
    healthy: list[float] = field(default_factory=list)
    locked: int = 0


@contextmanager
def service(files: int) -> Iterator[tuple[URL, int]]:
    """A service on loopback that needs no keys: (address, process)."""
    with tempfile.TemporaryDirectory(prefix="galatea-bench-") as folder:
        environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
        environment |= {"GALATEA_DATA_DIR": f"{folder}/data", "GALATEA_WORKER": "false", "PYTHONPATH": str(ROOT)}
        log = Path(folder) / "log"
        limit = (files, resource.getrlimit(resource.RLIMIT_NOFILE)[1])
        with log.open("wb") as output:
            process = subprocess.Popen(
                [sys.executable, "-m", "shell.main", "serve", "--port", "0"],
                env=environment, cwd=folder, stdout=output, stderr=output,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, limit),
            )  # fmt: skip
        try:
            while (found := re.search(r"serves at (http://\S+)/", log.read_text())) is None:
                if process.poll() is not None:
                    raise SystemExit(log.read_text())
                time.sleep(0.1)
            yield URL(found[1]), process.pid
            logged = Counter(re.findall(r"\[(?:warning|error) *\] (\S+)", log.read_text()))
            print("logged:", ", ".join(f"{event} ({count} times)" for event, count in logged.items()) or "nothing")
        finally:
            process.terminate()
            process.wait(30)


async def line(url: URL, sent: bytes, every: float | None, seen: Observed) -> None:
    """One line: says what it says, then a byte each few seconds (`every`) or nothing, until it is closed."""
    seen.asked += 1
    try:
        reader, writer = await asyncio.open_connection(url.host, url.port)
    except OSError:
        seen.answers["refused"] += 1
        return
    seen.open += 1
    answer = b""

    async def trickle() -> None:
        while every is not None:
            await asyncio.sleep(every)
            writer.write(b"a")
            await writer.drain()

    with suppress(OSError):
        writer.write(sent)
        slowly = asyncio.create_task(trickle())
        try:
            while piece := await reader.read(65536):
                answer = answer or piece
        finally:
            slowly.cancel()
            with suppress(OSError, asyncio.CancelledError):
                await slowly
            seen.open -= 1
            writer.transport.abort()
            status = re.match(rb"HTTP/1.1 (\d{3})", answer)
            seen.answers[status[1].decode() if status else "closed"] += 1


async def behave(url: URL, seen: Observed, until: float) -> None:
    """The client that behaves well."""
    while time.monotonic() < until:
        began = time.perf_counter()
        try:
            async with httpx.AsyncClient(timeout=LOCKED_AFTER_SECONDS) as http:
                status = (await http.get(url.join("/healthz"))).status_code
        except httpx.HTTPError:
            status = 0
        if status == 200:
            seen.healthy.append(time.perf_counter() - began)
        else:
            seen.locked += 1
        await asyncio.sleep(ASKING_SECONDS)


async def schedule(url: URL, count: int, sent: bytes, every: float | None, seconds: float) -> Observed:
    """Open so many lines, and look at the service for so long."""
    seen = Observed()
    until = time.monotonic() + seconds
    good = asyncio.create_task(behave(url, seen, until))
    lines = []
    for number in range(count):
        lines.append(asyncio.create_task(line(url, sent, every, seen)))
        if number % 50 == 49:
            await asyncio.sleep(OPENING_SECONDS * 50 / count)
            seen.most = max(seen.most, seen.open)
    while time.monotonic() < until:
        seen.most = max(seen.most, seen.open)
        await asyncio.sleep(0.1)
    await good
    still = seen.open
    for task in lines:
        task.cancel()
    ends = Counter(seen.answers)
    await asyncio.gather(*lines, return_exceptions=True)
    seen.answers, seen.open = ends, still
    return seen


async def waiting_job(url: URL) -> str:
    """A job that waits for good (there is no worker), for those who follow."""
    async with httpx.AsyncClient(base_url=url, timeout=60) as http:
        order = {"kind": "portrait", "driver": "idle"}
        made = await http.post("/v1/jobs", data=order, files={"image": ("portrait.jpg", portrait())})
        return str(made.raise_for_status().json()["id"])


async def run(url: URL, seconds: float) -> list[list[str]]:
    follow = FOLLOW_REQUEST.format(job=await waiting_job(url)).encode()
    schedules = [
        ("600 half-open lines", 600, b"", None),
        ("1200 heads without an end", 1200, SLOW_HEAD, 5.0),
        ("400 bodies, a byte each 5 s", 400, SLOW_BODY, 5.0),
        ("400 followers of events", 400, follow, None),
    ]
    rows = []
    for title, count, sent, every in schedules:
        seen = await schedule(url, count, sent, every, seconds)
        told = [seen.answers[status] for status in ("503", "408", "500")]
        figures = [seen.most, seen.open, *told, seen.answers["closed"] + seen.answers["refused"]]
        longest = f"{1000 * max(seen.healthy, default=float('inf')):.0f}"
        rows.append([title, *map(str, figures), str(len(seen.healthy)), str(seen.locked), longest])
        print(rows[-1], flush=True)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=30, help="how long each schedule is looked at")
    parser.add_argument("--files", type=int, default=1024, help="file descriptors that the service begins with")
    given = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    with service(given.files) as (url, pid):
        before = psutil.Process(pid).memory_info().rss
        rows = uvloop.run(run(url, given.seconds))
        grown = (psutil.Process(pid).memory_info().rss - before) / 1e6
    head = [
        "lines",
        "most open",
        "open at the end",
        "503",
        "408",
        "500",
        "closed",
        "healthy",
        "locked out",
        "longest ms",
    ]
    print(table(f"Lines that bring nothing, {given.seconds:.0f} s each (memory grew by {grown:.0f} MB)", head, rows))
    print(machine())


if __name__ == "__main__":
    main()
