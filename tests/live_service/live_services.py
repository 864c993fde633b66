"""Services that run, and small inputs for them."""

from __future__ import annotations

import gzip
import os
import subprocess
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from running import Running


@pytest.fixture(scope="session")
def shared_service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that lives as long as the tests, with small limits for what is uploaded. A module or a folder may have
    another one under this name."""
    page = tmp_path_factory.mktemp("page")
    (page / "index.html").write_text("<title>The page</title>")
    (page / "app.js").write_text("start()")
    assets = page / "assets"
    assets.mkdir()
    script = b"go();" * 1000
    (assets / "app-a1b2c3.js").write_bytes(script)
    (assets / "app-a1b2c3.js.br").write_bytes(b"as brotli")
    (assets / "app-a1b2c3.js.gz").write_bytes(gzip.compress(script))
    (page.parent / "secret.txt").write_text("not yours")
    data = tmp_path_factory.mktemp("data") / "data"
    service = Running(data, image_mb=1, video_mb=2, job_memory_mb=1500, web_dir=page, allowed_networks="127.0.0.0/8")
    yield service
    service.stop()


@pytest.fixture
def running(shared_service: Running) -> Iterator[Running]:
    """The shared service, in which no job waits or runs: what a test leaves is ended with the test."""
    yield shared_service
    shared_service.end_jobs()


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Running]]:
    """`start(setting=value)` is a service for one test that may do to it what it likes."""
    started: list[Running] = []

    def begin(data_dir: Path = tmp_path / "data", **settings: Any) -> Running:
        started.append(Running(data_dir, **{"lease_seconds": 3, "sweep_seconds": 0.5, **settings}))
        return started[-1]

    yield begin
    for service in started:
        service.stop()


@pytest.fixture(scope="session")
def picture() -> bytes:
    """A small PNG file."""
    file = BytesIO()
    Image.fromarray(np.random.default_rng(7).integers(0, 256, (20, 30, 3), np.uint8)).save(file, "PNG")
    return file.getvalue()


@pytest.fixture(scope="session")
def video() -> bytes:
    """The first bytes of an MP4 file: enough for the door, which decodes nothing."""
    return b"\x00\x00\x00\x18ftypisom\x00\x00\x02\x00isomiso2" + bytes(5000)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A folder with 60 MB of space."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = os.geteuid() == 0 and (
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=60m", "tmpfs", folder], capture_output=True).returncode == 0
    )
    if not mounted:
        pytest.skip("mounting a small disk needs root")
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)
