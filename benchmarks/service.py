"""How the service bears many clients: each posts small portraits and follows them, while the workers are saturated.

    python -m benchmarks.service --clients 200 --minutes 10

A real `galatea serve` runs in processes of its own over an empty folder; the clients are coroutines of this process.
They come with keys that allow few jobs at once, so that 429 is part of it; any other refusal is an error.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

import httpx
import numpy as np
import psutil
import uvloop

from benchmarks.presentation.tables import machine, table

ROOT = Path(__file__).parent.parent
JOB_OPTIONS = {"size": [128, 160], "trim": [0, 0.2]}
SAMPLE_SECONDS = 5.0
MAX_ANSWER_PAUSE_SECONDS = 10.0
ARRIVAL_SECONDS = 10.0
"""Over how long the clients come, and go. Whoever is told to come again waits up to half as long again, each another time, as
clients of many people do: all in the same instant, they would measure their own herd."""


@dataclass
class Observed:
    """What the clients met: seconds by endpoint, answers by endpoint and status, ends of jobs, samples over time."""

    seconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    answers: Counter[tuple[str, str]] = field(default_factory=Counter)
    ends: Counter[str] = field(default_factory=Counter)
    samples: list[tuple[float, float, float, float]] = field(default_factory=list)
    """(seconds, MB of the API, MB of the worker, seconds that the oldest job has waited)."""


@contextmanager
def service(keys: int, jobs_at_once: int) -> Iterator[tuple[str, list[str], int]]:
    """A service that asks for keys: (address, keys, process)."""
    with tempfile.TemporaryDirectory(prefix="galatea-bench-") as folder:
        environment = {name: value for name, value in os.environ.items() if not name.startswith("GALATEA_")}
        environment |= {
            "GALATEA_DATA_DIR": str(Path(folder) / "data"),
            "GALATEA_REQUIRE_KEYS": "true",
            "GALATEA_REQUESTS_PER_MINUTE": "100000",
            "PYTHONPATH": str(ROOT),
        }
        command = [sys.executable, "-m", "shell.main"]
        Path(environment["GALATEA_DATA_DIR"]).mkdir(mode=0o700)
        tokens = [_key(command, environment, f"client {i}", jobs_at_once) for i in range(keys)]
        log = Path(folder) / "log"
        with log.open("wb") as output:
            process = subprocess.Popen(
                [*command, "serve", "--port", "0"], env=environment, cwd=folder, stdout=output, stderr=output
            )
        try:
            while (found := re.search(r"serves at (http://\S+)/", log.read_text())) is None:
                if process.poll() is not None:
                    raise SystemExit(log.read_text())
                time.sleep(0.1)
            yield found[1], tokens, process.pid
        finally:
            process.terminate()
            process.wait(30)


def _key(command: list[str], environment: dict[str, str], name: str, jobs_at_once: int) -> str:
    scopes = ["--scope", "submit", "--scope", "read", "--scope", "admin"]
    made = subprocess.run(
        [*command, "keys", "create", name, *scopes, "--jobs-at-once", str(jobs_at_once)],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return made.stdout.strip()


async def client(http: httpx.AsyncClient, token: str, picture: bytes, seen: Observed, until: float) -> None:
    """One client: uploads once, then submits, follows, looks and fetches, again and again."""
    headers = {"Authorization": f"Bearer {token}"}

    async def call(endpoint: str, method: str, path: str, **more: object) -> httpx.Response:
        began = time.perf_counter()
        try:
            response = await http.request(method, path, headers=headers, **more)  # type: ignore[arg-type]
        except httpx.HTTPError as error:
            seen.answers[endpoint, type(error).__name__] += 1
            await asyncio.sleep(1)
            return httpx.Response(599)
        seen.seconds[endpoint].append(time.perf_counter() - began)
        code = f" {response.json()['code']}" if response.status_code >= 400 else ""
        seen.answers[endpoint, f"{response.status_code}{code}"] += 1
        return response

    await asyncio.sleep(random.uniform(0, ARRIVAL_SECONDS))
    until -= random.uniform(0, ARRIVAL_SECONDS)
    file = None
    while time.monotonic() < until:
        if file is None:
            sent = await call("POST /files", "POST", "/v1/files", files={"file": ("portrait.jpg", picture)})
            file = sent.json()["id"] if sent.status_code == 201 else None
            continue
        job = {"kind": "portrait", "inputs": {"image": file, "driver": "idle"}, "options": JOB_OPTIONS}
        made = await call("POST /jobs", "POST", "/v1/jobs", json=job)
        if made.status_code != 202:
            await call("GET /jobs", "GET", "/v1/jobs?limit=5")
            pause = min(float(made.headers.get("retry-after", 1)), MAX_ANSWER_PAUSE_SECONDS)
            await asyncio.sleep(pause * random.uniform(1, 1.5))
            continue
        path = made.headers["location"]
        await follow(http, headers, path, seen, until)
        shown = await call("GET /jobs/{id}", "GET", path)
        if shown.status_code == 200:
            seen.ends[shown.json()["status"]] += 1
            for artifact in list(shown.json()["artifacts"].values())[:1]:
                await call("GET artifact", "GET", artifact["url"])


async def follow(http: httpx.AsyncClient, headers: dict[str, str], path: str, seen: Observed, until: float) -> None:
    """Follow a job to its end, or to that of the time."""
    began = time.perf_counter()
    try:
        async with asyncio.timeout(max(until - time.monotonic(), 0.1)):
            async with http.stream("GET", f"{path}/events", headers=headers, timeout=None) as events:
                seen.seconds["GET events (first)"].append(time.perf_counter() - began)
                seen.answers["GET events (first)", str(events.status_code)] += 1
                async for _ in events.aiter_lines():
                    pass
    except TimeoutError:
        return
    except httpx.HTTPError as error:
        seen.answers["GET events (first)", type(error).__name__] += 1


async def sample(http: httpx.AsyncClient, token: str, pid: int, seen: Observed, until: float) -> None:
    """Memory and the queue's age, every few seconds."""
    began = time.monotonic()
    api = psutil.Process(pid)
    while time.monotonic() < until:
        workers = [p for p in api.children(recursive=True) if _works(p)]
        figures = await http.get("/metrics", headers={"Authorization": f"Bearer {token}"}, timeout=60)
        found = re.search(r'galatea_queue_oldest_seconds{kind="portrait"} (\S+)', figures.text)
        weights = [sum(p.memory_info().rss for p in some) / 1e6 for some in ([api], workers)]
        seen.samples.append((time.monotonic() - began, weights[0], weights[1], float(found[1]) if found else 0.0))
        await asyncio.sleep(SAMPLE_SECONDS)


def _works(process: psutil.Process) -> bool:
    try:
        return "shell.main worker" in " ".join(process.cmdline())
    except psutil.NoSuchProcess:  # a job's process that has just ended, a zombie included
        return False


def portrait() -> bytes:
    """A small picture of the project's own: a frame of a built-in performance."""
    from PIL import Image

    from engine.media.video import read_video
    from engine.performances import video

    file = BytesIO()
    frame = next(iter(read_video(video("happy"), longest_side=320)))
    Image.fromarray(np.ascontiguousarray(frame.rgb)).save(file, "JPEG")
    return file.getvalue()


async def load(address: str, tokens: list[str], pid: int, clients: int, minutes: float) -> Observed:
    """Let the clients loose."""
    seen, picture, until = Observed(), portrait(), time.monotonic() + minutes * 60
    limits = httpx.Limits(max_connections=None, max_keepalive_connections=None)
    async with httpx.AsyncClient(base_url=address, limits=limits, timeout=60) as http:
        tasks = [client(http, tokens[i % len(tokens)], picture, seen, until) for i in range(clients)]
        await asyncio.gather(sample(http, tokens[0], pid, seen, until), *tasks)
    return seen


def report(seen: Observed) -> str:
    """The tables."""
    rows = []
    everything = [second for seconds in seen.seconds.values() for second in seconds]
    for endpoint, seconds in [*sorted(seen.seconds.items()), ("all", everything)]:
        figures = np.percentile(np.array(seconds) * 1000, [50, 95, 99, 100])
        rows.append([endpoint, len(seconds), *(f"{figure:.0f}" for figure in figures)])
    answers = [[f"{endpoint}: {answer}", count] for (endpoint, answer), count in sorted(seen.answers.items())]
    step = max(1, len(seen.samples) // 10)
    weights = [
        [f"{t:.0f}", f"{api:.0f}", f"{worker:.0f}", f"{age:.0f}"] for t, api, worker, age in seen.samples[::step]
    ]
    return "\n".join(
        [
            table("API calls, milliseconds", ["endpoint", "calls", "p50", "p95", "p99", "most"], rows),
            table("Answers", ["endpoint and status", "count"], answers),
            table("Jobs ended", ["status", "count"], [list(one) for one in seen.ends.items()]),
            table("Memory over time", ["s", "API, MB", "worker, MB", "oldest waits, s"], weights),
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--keys", type=int, default=20)
    parser.add_argument("--jobs-at-once", type=int, default=8)
    asked = parser.parse_args()
    with service(asked.keys, asked.jobs_at_once) as (address, tokens, pid):
        seen = uvloop.run(load(address, tokens, pid, asked.clients, asked.minutes))
    print(machine())
    print(f"{asked.clients} clients, {asked.keys} keys of {asked.jobs_at_once} jobs at once, {asked.minutes:g} minutes")
    print(report(seen))


if __name__ == "__main__":
    main()
