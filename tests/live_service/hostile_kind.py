"""A job kind whose work tries what no job may do; it fails with what the system says."""

from __future__ import annotations

import ctypes
import json
import os
import signal
import socket
import threading
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from pydantic import BaseModel

from engine.kind import Input, Kind
from engine.run import Run


class HostileOptions(BaseModel):
    """What to try, at which path or process."""

    act: str
    path: str = ""
    process: int = 0


def connect(options: HostileOptions, out: Path) -> None:
    socket.create_connection(("127.0.0.1", options.process), timeout=5)


def connect_unix(options: HostileOptions, out: Path) -> None:
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(options.path)


def read(options: HostileOptions, out: Path) -> None:
    (out / "stolen.json").write_bytes(Path(options.path).read_bytes())


def look(options: HostileOptions, out: Path) -> None:
    next(Path(options.path).iterdir())


def write(options: HostileOptions, out: Path) -> None:
    Path(options.path).write_text("was here")


def link(options: HostileOptions, out: Path) -> None:
    os.link(options.path, out / "stolen.json")


def open_up(options: HostileOptions, out: Path) -> None:
    Path(options.path).chmod(0o777)


def fork(options: HostileOptions, out: Path) -> None:
    for _ in range(50):
        if os.fork() == 0:
            time.sleep(30)
            os._exit(0)


def execute(options: HostileOptions, out: Path) -> None:
    os.execv("/bin/sh", ["sh", "-c", "sleep 30"])


def end(options: HostileOptions, out: Path) -> None:
    os.kill(options.process, signal.SIGKILL)


def end_group(options: HostileOptions, out: Path) -> None:
    os.killpg(os.getpgrp(), signal.SIGKILL)


def escape_group(options: HostileOptions, out: Path) -> None:
    os.setsid()


def spy(options: HostileOptions, out: Path) -> None:
    Path(f"/proc/{options.process}/environ").read_bytes()


def trace(options: HostileOptions, out: Path) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.ptrace(16, options.process, None, None) != 0:  # PTRACE_ATTACH
        raise OSError(ctypes.get_errno(), "ptrace")


def old_interface(options: HostileOptions, out: Path) -> None:
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.syscall(0x40000000 + 41, 2, 1, 0) < 0:  # x32's socket
        raise OSError(ctypes.get_errno(), "x32")


def spin(options: HostileOptions, out: Path) -> None:
    def turn() -> None:
        while True:
            np.linalg.svd(np.ones((100, 100)))

    for _ in range(3):
        threading.Thread(target=turn, daemon=True).start()
    turn()


def spin_deafly(options: HostileOptions, out: Path) -> None:
    signal.signal(signal.SIGXCPU, signal.SIG_IGN)
    while True:
        pass


def eat(options: HostileOptions, out: Path) -> None:
    eaten = []
    while True:
        eaten.append(np.ones(1 << 23))


def behave(options: HostileOptions, out: Path) -> None:
    """What honest work does: threads, temporary files, shared numbers, its own folders, linear algebra."""
    from concurrent.futures import ThreadPoolExecutor
    from tempfile import TemporaryDirectory

    with ThreadPoolExecutor(4) as pool, TemporaryDirectory() as folder:
        assert sum(pool.map(lambda n: float(np.linalg.norm(np.ones((n, n)) @ np.ones((n, n)))), range(1, 200))) > 0
        (Path(folder) / "a").write_text(f"{os.cpu_count()} {Path('/proc/self/statm').read_text()}")
        (Path(folder) / "a").rename(out / "a.json")


def who(options: HostileOptions, out: Path) -> None:
    """Tells as whom it works."""
    (out / "who.json").write_text(json.dumps({"user": os.getresuid(), "group": os.getresgid(), "more": os.getgroups()}))


def work(inputs: Mapping[str, Path | tuple[Path, ...]], options: BaseModel, out: Path, run: Run) -> None:
    assert isinstance(options, HostileOptions)
    globals()[options.act](options, out)


KIND = Kind(
    name="hostile",
    summary="Tries what no job may do.",
    inputs=(Input("image", "image", "a picture", required=False),),
    options=HostileOptions,
    work=work,
)
