"""Faults at random moments, one after another; after each, everything that was accepted is as it should be.

`GALATEA_FAULT_ROUNDS` says how many (every kind of fault comes before one comes again), `GALATEA_FAULT_SEED` which.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import sqlite3
import threading
import time
from collections import Counter
from pathlib import Path
from random import Random
from typing import Any

import httpx
import numpy as np
import pytest
from faults import FAULTS, Fault, Scene, answer_again, ready
from PIL import Image
from receiver import Receiver
from running import Running, eventually

from service.context import Context
from service.settings import Settings
from worker.periodic.housekeeping import keep_house

ROUNDS = int(os.environ.get("GALATEA_FAULT_ROUNDS", "17"))
SEED = int(os.environ.get("GALATEA_FAULT_SEED", "1"))
WITHIN_SECONDS = 180


def schedule(rng: Random, disk: Path | None) -> list[Fault]:
    """Each fault once in random order, then again in another, until there are enough."""
    possible = [fault for fault in FAULTS if disk is not None or not fault.needs_disk]
    rounds: list[Fault] = []
    while len(rounds) < ROUNDS:
        rounds += rng.sample(possible, len(possible))
    return rounds[:ROUNDS]


def submit(scene: Scene, picture: bytes, key: str, **options: Any) -> str | None:
    """A job's id, once it is accepted; asked again under the same key while nobody answers. None if it is refused for
    want of space."""
    form = {"kind": "tiny", "options": json.dumps(options)}
    deadline = time.monotonic() + WITHIN_SECONDS
    while time.monotonic() < deadline:
        try:
            answer = scene.running.client.post(
                "/v1/jobs", data=form, files={"image": ("a.png", picture)}, headers={"Idempotency-Key": key}, timeout=20
            )
        except (httpx.HTTPError, RuntimeError):  # nobody is there, or the client was closed for a restart
            time.sleep(0.3)
            continue
        scene.answers[answer.status_code] += 1
        if answer.status_code == 202:
            return str(answer.json()["id"])
        if answer.status_code == 507:
            return None
        assert answer.status_code == 503, answer.text
        time.sleep(0.3)
    raise AssertionError("nobody accepts the job")


def picture_of(rng: Random) -> bytes:
    """A picture that no other job has."""
    file = io.BytesIO()
    pixels = np.random.default_rng(rng.randrange(1 << 30)).integers(0, 256, (20, 30, 3), np.uint8)
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


def strike(scene: Scene, fault: Fault, number: int) -> list[str]:
    """The fault, and jobs that come before, while and after it happens: their ids, as far as they were accepted."""
    jobs: list[str | None] = []
    pictures = {when: picture_of(scene.rng) for when in ("before", "queued", "meanwhile", "after")}

    def one(when: str, seconds: float) -> None:
        jobs.append(submit(scene, pictures[when], f"{number}-{when}", seconds=seconds))

    one("before", round(scene.rng.uniform(0.5, 2), 2))
    one("queued", 0.2)
    time.sleep(scene.rng.uniform(0, 1.5))
    meanwhile = threading.Thread(target=one, args=("meanwhile", 0.1))
    meanwhile.start()
    fault.strike(scene)
    fault.mend(scene)
    meanwhile.join(WITHIN_SECONDS)
    ready(scene)
    one("after", 0.1)
    assert len(jobs) == 4 and (fault.needs_disk or None not in jobs)
    return [job for job in jobs if job is not None]


def check_doomed(scene: Scene, job_id: str) -> str:
    """It has ended once, and says how."""
    error = scene.running.until(job_id, "succeeded", "failed", "canceled", seconds=WITHIN_SECONDS)["error"]
    assert error["code"] == "process_died" and "SIGABRT" in error["detail"], error
    return str(error["code"])


def check_job(scene: Scene, job_id: str, fault: Fault) -> str:
    """It has ended once, and what it left is whole."""
    running = scene.running
    job = running.until(job_id, "succeeded", "failed", "canceled", seconds=WITHIN_SECONDS)
    end = job["error"]["code"] if job["error"] else job["status"]
    assert end == "succeeded" or (fault.needs_disk and end == "disk_full"), (fault.name, job["error"])
    with running.client.stream("GET", f"/v1/jobs/{job_id}/events") as events:
        told = events.read().decode()
    assert sum(told.count(f'"status": "{status}"') for status in ("succeeded", "failed", "canceled")) == 1, told
    if end == "succeeded":
        assert {"report.json", "animation.mp4", "preview.jpg", "spectrum.json"} <= job["artifacts"].keys()
    for artifact in job["artifacts"].values():
        content = running.client.get(artifact["url"]).raise_for_status().content
        assert (len(content), hashlib.sha256(content).hexdigest()) == (artifact["size"], artifact["sha256"])
    return end


def told_of(receiver: Receiver) -> Counter[str]:
    """How often the end of each job was told."""
    return Counter(call.json["data"]["id"] for call in list(receiver.calls))


def at_rest(running: Running) -> bool:
    """Whether nothing is under way."""
    database = sqlite3.connect(running.data_dir / "galatea.db", timeout=30)
    query = "SELECT count(*) FROM jobs WHERE status IN ('queued', 'running') OR lease_owner IS NOT NULL"
    (busy,) = database.execute(query).fetchone()
    database.close()
    return busy == 0


def undelivered(running: Running) -> int:
    """How many calls nobody has said yes to yet."""
    database = sqlite3.connect(running.data_dir / "galatea.db", timeout=30)
    (count,) = database.execute("SELECT count(*) FROM webhook_deliveries WHERE status != 'delivered'").fetchone()
    database.close()
    return int(count)


def leftovers(running: Running) -> list[str]:
    """What lies on disk without a record, and what is recorded and not there, once housekeeping has been by two hours
    later."""
    old = time.time() - 7200
    for path in running.data_dir.rglob("*"):
        if "galatea.db" not in path.name and "redis" not in path.parts:
            os.utime(path, (old, old), follow_symlinks=False)
    context = Context.open(Settings(data_dir=running.data_dir, kinds=[], disk_reserve_mb=0))
    try:
        keep_house(context)
    finally:
        context.close()
    database = sqlite3.connect(running.data_dir / "galatea.db")
    there = {path.name for name in ("files", "artifacts") for path in (running.data_dir / "storage" / name).rglob("*")}
    known = {row[0] for table in ("files", "artifacts") for row in database.execute(f"SELECT id FROM {table}")}
    database.close()
    attempts = [str(path) for path in (running.data_dir / "jobs").glob("*/*") if path.name != "stages"]
    incoming = [str(path) for path in (running.data_dir / "incoming").glob("*")]
    return [*(there ^ known), *attempts, *incoming]


@pytest.mark.timeout(120 + 240 * ROUNDS)
def test_whatever_happens_each_accepted_job_ends_once_and_whole(tmp_path: Path, disk: Path | None) -> None:
    rng, receiver = Random(SEED), Receiver()
    running = Running(
        (disk or tmp_path) / "data", lease_seconds=3, sweep_seconds=0.5, disk_reserve_mb=10, concurrency=2, silent_seconds=5,
        allowed_networks="127.0.0.0/8", webhook_seconds=2, webhook_connect_seconds=1,
    )  # fmt: skip
    scene = Scene(running, receiver, disk, rng)
    events = {"url": receiver.url, "events": ["job.succeeded", "job.failed", "job.canceled"]}
    running.client.post("/v1/webhooks", json=events).raise_for_status()
    ends: Counter[str] = Counter()
    accepted: list[str] = []
    try:
        for number, fault in enumerate(schedule(rng, disk)):
            began = time.monotonic()
            jobs = strike(scene, fault, number)
            ends.update(check_job(scene, job, fault) for job in jobs)
            doomed, scene.doomed = scene.doomed, []
            ends.update(check_doomed(scene, job) for job in doomed)
            accepted.extend([*jobs, *doomed])
            eventually(lambda: at_rest(running), "nothing is stuck", WITHIN_SECONDS)
            answer_again(scene)
            untold = f"all ends are told after: {fault.name}"
            eventually(lambda: undelivered(running) == 0, untold, WITHIN_SECONDS)
            print(f"{number + 1:3} {fault.name}: {len(jobs)} jobs, {time.monotonic() - began:.1f} s", flush=True)
        calls = told_of(receiver)
        print(dict(ends), f"{len(accepted)} jobs, {sum(calls.values())} calls")
        lost = len(set(accepted) - calls.keys())
        print(f"{lost} lost, {scene.answers[500]} times 500", flush=True)
        assert calls.keys() == set(accepted) and len(set(accepted)) == len(accepted)
        running.stop()
        assert leftovers(running) == []
    finally:
        running.stop()
        receiver.close()
