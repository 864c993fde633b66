"""Stages of a job, kept in a bucket for other machines."""

from __future__ import annotations

import io
import tarfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from servers import S3Server

from engine.store import StageStore
from service.settings import Settings
from service.storage.bucket import Bucket
from worker.job_files.mirror import Mirror

KEY, OTHER = "a" * 40, "b" * 40


@pytest.fixture
def bucket(s3: S3Server) -> Bucket:
    return Bucket(Settings(**s3.new_bucket(), storage_region="us-east-1"))


@pytest.fixture
def machine(tmp_path: Path, bucket: Bucket) -> Iterator[object]:
    """`machine("a")` is a mirror over that machine's folder of stages."""
    opened: list[Mirror] = []

    def of(name: str, tree: str = "tree") -> Mirror:
        for folder in (tmp_path / name / "stages", tmp_path / name / "temporary"):
            folder.mkdir(parents=True, exist_ok=True)
        opened.append(Mirror(bucket, tree, tmp_path / name / "stages", tmp_path / name / "temporary"))
        return opened[-1]

    yield of
    for one in opened:
        one.close(wait=True)


def store(tmp_path: Path, name: str) -> StageStore:
    return StageStore(tmp_path / name / "stages")


def test_what_one_machine_found_another_has_byte_for_byte(tmp_path: Path, machine, bucket: Bucket) -> None:  # type: ignore[no-untyped-def]
    first = machine("a")
    found = np.random.default_rng(1).normal(size=(200, 3000))
    store(tmp_path, "a").save(KEY, found)
    store(tmp_path, "a").save(OTHER, np.arange(5))
    for key in (KEY, OTHER, KEY):
        first.keep(key)
    first.close(wait=True)
    machine("b").restore()
    for key in (KEY, OTHER):
        here, there = (sorted((tmp_path / name / "stages" / key).iterdir()) for name in "ab")
        assert [path.read_bytes() for path in here] == [path.read_bytes() for path in there]
    kept = store(tmp_path, "b").load(KEY, np.ndarray)
    assert kept is not None and np.array_equal(kept[1], found)
    assert list((tmp_path / "b" / "temporary").iterdir()) == []
    machine("c", tree="another").restore()
    assert list((tmp_path / "c" / "stages").iterdir()) == []


def test_links_do_not_get_out(tmp_path: Path, machine, bucket: Bucket) -> None:  # type: ignore[no-untyped-def]
    first = machine("a")
    (tmp_path / "a" / "stages" / KEY).mkdir()
    (tmp_path / "a" / "stages" / KEY / "arrays.npz").symlink_to("/etc/hostname")
    first.keep(KEY)
    first.keep("../../etc")
    first.close(wait=True)
    assert list(bucket.keys("stages")) == []


def test_nothing_but_plain_files_comes_in(tmp_path: Path, machine, bucket: Bucket) -> None:  # type: ignore[no-untyped-def]
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as tar:
        for name, kind in (("../out", tarfile.REGTYPE), ("/tmp/out", tarfile.REGTYPE), ("good.json", tarfile.REGTYPE)):
            entry = tarfile.TarInfo(name)
            entry.type, entry.size = kind, 2
            tar.addfile(entry, io.BytesIO(b"{}"))
        link = tarfile.TarInfo("link.json")
        link.type, link.linkname = tarfile.SYMTYPE, "/etc/hostname"
        tar.addfile(link)
    packed.seek(0)
    bucket.put(f"stages/tree/{KEY}", packed)
    bucket.put(f"stages/tree/{OTHER}", io.BytesIO(b"no tar at all"))
    machine("b").restore()
    stages = tmp_path / "b" / "stages"
    assert [str(path.relative_to(stages)) for path in sorted(stages.rglob("*"))] == [KEY, f"{KEY}/good.json"]
    assert not (tmp_path / "b" / "out").exists()
