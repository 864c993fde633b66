"""What only a real server shows: it is killed in the middle of an upload, and it keeps no byte of what was erased.

`make s3-trial` runs this after the tests that borrow any S3 server; by itself pytest does not collect it.
"""

from __future__ import annotations

import hashlib
import io
import os
import socket
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from threading import Lock

import numpy as np
import pytest
from PIL import Image
from running import Running, eventually
from servers import Gate
from swift import Swift

from service.settings import Settings
from service.storage.bucket import Bucket
from service.storage.files import PART_BYTES, StorageUnavailable

SIDE = 2700


class Fuse(Gate):
    """A way to a server that does something once, when so many bytes have come to the server on it."""

    def __init__(self, server: Swift, after: int, then: Callable[[], None]):
        self._left, self._then, self._counted = after, then, Lock()
        self._server_port = server.port
        super().__init__(server.host, server.port)

    def _pass_on(self, source: socket.socket, target: socket.socket) -> None:  # type: ignore[override]
        with suppress(OSError):
            towards = target.getpeername()[1] == self._server_port
            while data := source.recv(1 << 16):
                if towards:
                    self._count(len(data))
                target.sendall(data)
        for end in (source, target):
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def _count(self, size: int) -> None:
        with self._counted:
            before, self._left = self._left, self._left - size
            if before > 0 >= self._left:
                self._then()

    @property
    def burnt(self) -> bool:
        return self._left <= 0


@pytest.fixture
def swift(tmp_path: Path) -> Iterator[Swift]:
    server = Swift()
    yield server
    server.remove()


@pytest.fixture(scope="module")
def large_picture() -> bytes:
    """A PNG file of three parts."""
    file = io.BytesIO()
    Image.fromarray(np.random.default_rng(7).integers(0, 256, (SIDE, SIDE, 3), np.uint8)).save(file, "PNG")
    assert file.tell() > 2 * PART_BYTES
    return file.getvalue()


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


@pytest.fixture(scope="module")
def keeper() -> Iterator[Executor]:
    """Who starts a server again: its processes end with the thread that started them."""
    with ThreadPoolExecutor(1) as thread:
        yield thread


def through(way: Gate) -> dict[str, str]:
    return {"storage_endpoint": f"http://127.0.0.1:{way.port}", "storage_region": "us-east-1"}


@pytest.mark.parametrize("comes_back", [True, False])
def test_an_upload_that_the_server_does_not_survive_is_whole_or_refused(
    swift: Swift, keeper: Executor, tmp_path: Path, comes_back: bool
) -> None:
    given = swift.new_bucket()
    direct = Bucket(Settings(**given, storage_region="us-east-1"))

    def held() -> dict[str, str]:
        return {key: digest(direct.fetch(key, tmp_path / "copy").read_bytes()) for key in direct.keys("files")}

    def fall() -> None:
        swift.stop()
        if comes_back:
            back.append(keeper.submit(swift.start))

    old, new = os.urandom(2 * PART_BYTES + 1), os.urandom(3 * PART_BYTES)
    expected = dict.fromkeys(("files/before", "files/replaced"), digest(old))
    for key in expected:
        direct.put(key, io.BytesIO(old))
    back: list[Future[None]] = []
    for key in ("files/replaced", "files/new"):
        fuse = Fuse(swift, PART_BYTES + PART_BYTES // 2, fall)
        try:
            Bucket(Settings(**given | through(fuse))).put(key, io.BytesIO(new))
            expected[key] = digest(new)
        except StorageUnavailable as refusal:
            print(key, "refused:", refusal.strerror)
        assert fuse.burnt, "it was killed in the middle"
        if not comes_back:
            assert expected.get(key) != digest(new), "it cannot be there"
            swift.start()
        while back:
            back.pop().result()
        assert held() == expected, "the new whole, or all as it was"
        fuse.shut()
        direct.put(key, io.BytesIO(new))
        expected[key] = digest(new)
        assert held() == expected


def test_a_job_whose_storage_is_killed_in_the_upload_of_its_picture_loses_nothing(
    swift: Swift, keeper: Executor, tmp_path: Path, large_picture: bytes
) -> None:
    def fall() -> None:
        swift.stop()
        keeper.submit(swift.start)

    fuse = Fuse(swift, PART_BYTES + PART_BYTES // 2, fall)
    running = Running(tmp_path / "data", sweep_seconds=0.5, **swift.new_bucket() | through(fuse))
    try:
        answers = []

        def uploaded() -> bool:
            answer = running.client.post("/v1/files", files={"file": ("a.png", large_picture)}, timeout=300)
            answers.append(answer.status_code)
            if answer.status_code != 201:
                assert (answer.status_code, answer.json()["code"]) == (503, "unavailable")
                return False
            answers.append(answer.json()["id"])
            return True

        eventually(uploaded, "the picture is taken", 300)
        assert fuse.burnt
        print("answers to the upload:", answers)
        asked = {"kind": "tiny", "inputs": {"image": answers[-1]}}
        job = running.client.post("/v1/jobs", json=asked).raise_for_status().json()
        done = running.until(job["id"], "succeeded")
        for artifact in done["artifacts"].values():
            content = running.client.get(artifact["url"]).content
            assert digest(content) == artifact["sha256"]
        assert running.client.get(done["artifacts"]["preview.jpg"]["url"]).content == large_picture
    finally:
        running.stop()


def test_of_an_erased_job_the_server_keeps_not_one_byte(swift: Swift, tmp_path: Path, large_picture: bytes) -> None:
    running = Running(tmp_path / "data", sweep_seconds=0.5, **swift.new_bucket())
    try:
        done = running.until(running.submit(large_picture)["id"], "succeeded")
        assert swift.kept() > 2 * len(large_picture), "the picture, and the preview that is a copy of it"
        running.client.delete(f"/v1/jobs/{done['id']}").raise_for_status()
        eventually(lambda: swift.kept() == 0, "no byte of it is left on the disk")
    finally:
        running.stop()
