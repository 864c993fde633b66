"""What can go wrong under a running service, each as one action at one moment; `mend` makes it good again."""

from __future__ import annotations

import socket
import sqlite3
import subprocess
import threading
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random

import redis
from receiver import OK, Receiver, status
from running import Running, eventually

from service.redis_server import socket_path

MOMENTS = {
    "jobs": ("created_at", "started_at", "progress_at", "enqueued_at", "lease_expires_at"),
    "webhook_deliveries": ("created_at", "next_attempt_at", "lease_expires_at"),
    "webhooks": ("created_at", "failing_since"),
}
"""What is compared with the clock."""


@dataclass
class Scene:
    """A service, who receives its webhooks, and the disk that it has for itself (None: it shares the machine's)."""

    running: Running
    receiver: Receiver
    disk: Path | None
    rng: Random
    answers: Counter[int] = field(default_factory=Counter)
    """How often each status was answered to who submitted a job."""
    doomed: list[str] = field(default_factory=list)
    """Jobs whose input ends their process."""


def shift_clock(scene: Scene, seconds: int) -> None:
    """Let the clock jump: to the service it is the same whether the time of day moves on or all stored moments back."""
    database = sqlite3.connect(scene.running.data_dir / "galatea.db", timeout=30)
    with database:
        for table, columns in MOMENTS.items():
            for column in columns:
                later = f"strftime('%Y-%m-%d %H:%M:%f000', {column}, '{-seconds} seconds')"
                database.execute(f"UPDATE {table} SET {column} = {later} WHERE {column} IS NOT NULL")
    database.close()


def kill(scene: Scene, part: str) -> None:
    found = scene.running.processes(part)
    if found:
        scene.rng.choice(found).kill()


def freeze(scene: Scene, part: str) -> None:
    """Nobody thaws it: the service has to miss it."""
    found = [one for one in scene.running.processes(part) if one.ppid() == scene.running.process.pid]
    for one in found:
        one.suspend()


def abort(scene: Scene) -> None:
    """A job's input brings a library to abort the process, whenever it is tried."""
    picture = Path(__file__).with_name("faults.py").read_bytes()  # no matter of what: it is not decoded
    file = scene.running.client.post("/v1/files", files={"file": ("a.png", b"\x89PNG\r\n\x1a\n" + picture)})
    job = {"kind": "tiny", "inputs": {"image": file.raise_for_status().json()["id"]}, "options": {"crash": "abort"}}
    scene.doomed.append(scene.running.client.post("/v1/jobs", json=job).raise_for_status().json()["id"])


def kill_everything(scene: Scene) -> None:
    scene.running.process.kill()
    scene.running.process.wait(90)


def restart(scene: Scene) -> None:
    scene.running.client.close()
    scene.running.start()


def empty_redis(scene: Scene) -> None:
    client = redis.Redis(unix_socket_path=str(socket_path(scene.running.data_dir)))
    client.flushall()
    client.close()


def lock_database(scene: Scene) -> None:
    database = sqlite3.connect(scene.running.data_dir / "galatea.db", timeout=30, isolation_level=None)
    database.execute("BEGIN IMMEDIATE")
    time.sleep(scene.rng.uniform(1, 3))
    database.execute("ROLLBACK")
    database.close()


def fill_disk(scene: Scene) -> None:
    assert scene.disk is not None
    subprocess.run(["dd", "if=/dev/zero", f"of={scene.disk / 'ballast'}", "bs=1M"], capture_output=True)
    time.sleep(scene.rng.uniform(0.5, 2))


def free_disk(scene: Scene) -> None:
    assert scene.disk is not None
    (scene.disk / "ballast").unlink(missing_ok=True)


def send_slowly(scene: Scene) -> None:
    """Clients that dawdle over their bodies and then hang up; others must not wait for them."""
    address = scene.running.client.base_url

    def dawdle() -> None:
        with socket.create_connection((address.host, address.port or 80)) as line:
            line.sendall(
                b"POST /v1/files HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 90000\r\n"
                b"Content-Type: multipart/form-data; boundary=edge\r\n\r\n--edge\r\n"
                b'Content-Disposition: form-data; name="file"; filename="a.png"\r\n\r\n\x89PNG\r\n\x1a\n'
            )
            for _ in range(10):
                line.sendall(bytes(100))
                time.sleep(0.1)

    threads = [threading.Thread(target=dawdle, daemon=True) for _ in range(20)]
    for thread in threads:
        thread.start()
    assert scene.running.client.get("/healthz").status_code == 200
    for thread in threads:
        thread.join()


def cut_calls_off(scene: Scene) -> None:
    """The receiver hangs up on each call before it answers."""
    scene.receiver.answer = lambda request: request.connection.close()


def answer_slowly(scene: Scene) -> None:
    scene.receiver.answer = lambda request: time.sleep(3)


def redirect(scene: Scene) -> None:
    scene.receiver.answer = status(302, Location="http://169.254.169.254/latest/meta-data")


def fail_for_an_hour(scene: Scene) -> None:
    """The receiver answers 500 while an hour passes in six steps."""
    scene.receiver.answer = status(500, b"not today")
    for _ in range(6):
        time.sleep(0.6)
        shift_clock(scene, 600)


def answer_again(scene: Scene) -> None:
    """The receiver answers, and all calls that are due later are due now."""
    scene.receiver.answer = OK
    shift_clock(scene, 90_000)


def nothing(scene: Scene) -> None:
    """It mends itself."""


@dataclass(frozen=True)
class Fault:
    """What happens, and how it is made good."""

    name: str
    strike: Callable[[Scene], None]
    mend: Callable[[Scene], None] = nothing
    needs_disk: bool = False


FAULTS = (
    Fault("a job's process is killed", lambda scene: kill(scene, "worker.job_process.child")),
    Fault("the worker is killed", lambda scene: kill(scene, "shell.main worker")),
    Fault("the API is killed, and all with it", kill_everything, restart),
    Fault("the worker is frozen", lambda scene: freeze(scene, "shell.main worker")),
    Fault("an input aborts its process", abort),
    Fault("Redis is frozen", lambda scene: freeze(scene, "redis-server")),
    Fault("Redis is killed", lambda scene: kill(scene, "redis-server")),
    Fault("Redis is emptied", empty_redis),
    Fault("the database is locked", lock_database),
    Fault("the disk is full", fill_disk, free_disk, needs_disk=True),
    Fault("the clock jumps ahead", lambda scene: shift_clock(scene, 3600)),
    Fault("the clock jumps back", lambda scene: shift_clock(scene, -3600)),
    Fault("clients are slow", send_slowly),
    Fault("the receiver is down", cut_calls_off, answer_again),
    Fault("the receiver is slow", answer_slowly, answer_again),
    Fault("the receiver redirects", redirect, answer_again),
    Fault("the receiver answers 500 for an hour", fail_for_an_hour, answer_again),
)


def ready(scene: Scene) -> None:
    """Wait until the service is whole again."""
    eventually(lambda: scene.running.client.get("/readyz").status_code == 200, "the service is ready", 300)
