"""The storage: a folder and a bucket do the same."""

from __future__ import annotations

import asyncio
import hashlib
import io
import os
from datetime import timedelta
from pathlib import Path

import pytest
from pydantic import ValidationError
from servers import Gate, S3Server

from service.clock import now
from service.database import postgresql
from service.settings import Settings
from service.storage.bucket import Bucket
from service.storage.files import PART_BYTES, Storage, StorageUnavailable


@pytest.fixture(params=["folder", "bucket"])
def storage(request: pytest.FixtureRequest, tmp_path: Path) -> Storage:
    if request.param == "folder":
        return Storage(tmp_path / "storage")
    s3: S3Server = request.getfixturevalue("s3")
    return Bucket(Settings(**s3.new_bucket(), storage_region="us-east-1"))


def read(storage: Storage, key: str, start: int, end: int) -> bytes:
    async def pieces() -> bytes:
        return b"".join([piece async for piece in storage.read(key, start, end)])

    return asyncio.run(pieces())


def test_what_is_put_is_there_whole_and_in_parts(storage: Storage, tmp_path: Path) -> None:
    large = os.urandom(PART_BYTES * 2 + 12345)  # so large that a bucket gets it in three parts
    storage.put("files/large", io.BytesIO(large))
    storage.put("files/empty", io.BytesIO(b""))
    assert read(storage, "files/large", PART_BYTES - 5, PART_BYTES + 5) == large[PART_BYTES - 5 : PART_BYTES + 5]
    assert read(storage, "files/large", 0, len(large)) == large
    assert read(storage, "files/empty", 0, 0) == b""
    copy = storage.fetch("files/large", tmp_path / "copy")
    assert hashlib.sha256(copy.read_bytes()).digest() == hashlib.sha256(large).digest()
    storage.put("files/large", io.BytesIO(b"another"))
    assert read(storage, "files/large", 0, 7) == b"another"


def test_lists_come_whole_however_long(storage: Storage) -> None:
    for number in range(60):  # the test's S3 server lists fifty at a time
        storage.put(f"artifacts/{number:03}", io.BytesIO(b"x" * number))
    storage.put("artifactsnot/1", io.BytesIO(b"x"))
    assert sorted(storage.keys("artifacts")) == [f"artifacts/{number:03}" for number in range(60)]
    assert storage.sizes("artifacts")["artifacts/007"] == 7
    assert list(storage.keys("artifacts", now() - timedelta(hours=1))) == []
    assert len(list(storage.keys("artifacts", now() + timedelta(hours=1)))) == 60
    storage.delete(["artifacts/003", "artifacts/003", "artifacts/nothing"])
    assert len(list(storage.keys("artifacts"))) == 59
    storage.delete_under("artifacts")
    assert list(storage.keys("")) == ["artifactsnot/1"]


def test_what_is_not_there_is_said(storage: Storage, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read(storage, "files/nothing", 0, 5)
    assert list(storage.keys("nothing")) == []
    assert storage.reachable()


def test_a_bucket_that_is_away_or_is_not_there_is_said(s3: S3Server) -> None:
    way = Gate(s3.host, s3.port)
    given = s3.new_bucket() | {"storage_endpoint": f"http://127.0.0.1:{way.port}", "storage_region": "us-east-1"}
    bucket = Bucket(Settings(**given))
    assert bucket.reachable()
    assert not Bucket(Settings(**given | {"storage_url": "s3://no-such-bucket"})).reachable()
    bucket.put("files/a", io.BytesIO(b"abc"))
    way.shut()
    assert not bucket.reachable()
    with pytest.raises(StorageUnavailable):
        read(bucket, "files/a", 0, 3)
    bucket.delete(["files/a"])  # no error: housekeeping will see to it
    way.open()
    assert read(bucket, "files/a", 0, 3) == b"abc"


@pytest.mark.parametrize("url", ["gs://x", "s3://", "s3://Bucket", "/folder", "s3://bucket/a b"])
def test_addresses_of_no_bucket(url: str) -> None:
    with pytest.raises(ValidationError, match="s3://BUCKET"):
        Settings(storage_url=url)


def test_addresses_of_postgresql() -> None:
    place, arguments = postgresql.address("postgresql://me:p%40ss@db.example:5433/galatea?sslmode=verify-full")
    assert (place.drivername, place.host, place.port, place.password) == (
        *("postgresql+pg8000", "db.example", 5433, "p@ss"),
    )
    assert arguments["ssl_context"].check_hostname
    place, arguments = postgresql.address("postgres://me@/galatea?host=/run/postgresql")
    assert (place.host, arguments["unix_sock"]) == (None, "/run/postgresql/.s.PGSQL.5432")
    for wrong in ("mysql://x/y", "postgresql://host", "postgresql://host/db?sslmode=maybe", "postgresql://h/db?x=1"):
        with pytest.raises(ValidationError, match="database_url"):
            Settings(database_url=wrong)
