"""Fetching artifacts: whole, in parts, only if changed."""

from __future__ import annotations

import asyncio
import hashlib
import subprocess
import sys
from datetime import UTC, datetime
from email.message import Message
from email.parser import BytesParser
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
from hypothesis import given
from hypothesis import strategies as st
from running import Running

from service.artifacts.archive import zipped
from service.http.ranges import Unsatisfiable, parse_ranges
from service.ids import new_id
from service.storage.files import Storage
from service.tables.artifacts import Artifact

WHOLE = bytes(range(256)) * 400
SIZE = len(WHOLE)


@pytest.fixture(scope="module")
def artifact(shared_service: Running, picture: bytes) -> dict[str, Any]:
    job = shared_service.until(shared_service.submit(picture)["id"], "succeeded")
    return job["artifacts"]["animation.mp4"]


def test_whole(running: Running, artifact: dict[str, Any]) -> None:
    response = running.client.get(artifact["url"])
    assert response.status_code == 200
    assert response.content == WHOLE
    assert hashlib.sha256(WHOLE).hexdigest() == artifact["sha256"]
    assert response.headers["etag"] == f'"{artifact["sha256"]}"'
    assert response.headers["content-type"] == artifact["content_type"] == "video/mp4"
    assert response.headers["content-length"] == str(SIZE) == str(artifact["size"])
    assert response.headers["accept-ranges"] == "bytes"
    assert response.headers["x-content-type-options"] == "nosniff"
    policy = response.headers["content-security-policy"].split("; ")
    assert {"default-src 'none'", "sandbox allow-same-origin"} <= set(policy), "no script runs, from wherever"
    assert not any(part.startswith("script") for part in policy)
    assert 'filename="animation.mp4"' in response.headers["content-disposition"]
    head = running.client.head(artifact["url"])
    assert head.content == b""
    varying = ("date", "x-request-id")
    assert {k: v for k, v in head.headers.items() if k not in varying} == {
        k: v for k, v in response.headers.items() if k not in varying
    }


@pytest.mark.parametrize(
    ("asked", "start", "end"),
    [
        ("0-0", 0, 1),
        ("100-199", 100, 200),
        (f"{SIZE - 5}-", SIZE - 5, SIZE),
        ("-7", SIZE - 7, SIZE),
        ("5-999999999", 5, SIZE),
        ("-999999999", 0, SIZE),
        ("10-20,15-30", 10, 31),
    ],
)
def test_one_range(running: Running, artifact: dict[str, Any], asked: str, start: int, end: int) -> None:
    response = running.client.get(artifact["url"], headers={"Range": f"bytes={asked}"})
    assert response.status_code == 206
    assert response.content == WHOLE[start:end]
    assert response.headers["content-range"] == f"bytes {start}-{end - 1}/{SIZE}"
    assert response.headers["content-length"] == str(end - start)


def test_ranges_are_of_get_alone(running: Running, artifact: dict[str, Any]) -> None:
    """RFC 9110, section 14.2."""
    response = running.client.head(artifact["url"], headers={"Range": "bytes=0-9"})
    assert (response.status_code, response.headers["content-length"]) == (200, str(SIZE))
    assert "content-range" not in response.headers


def test_several_ranges(running: Running, artifact: dict[str, Any]) -> None:
    response = running.client.get(artifact["url"], headers={"Range": "bytes=0-9, 1000-1099, -3"})
    assert response.status_code == 206
    assert len(response.content) == int(response.headers["content-length"])
    head = f"Content-Type: {response.headers['content-type']}\r\n\r\n".encode()
    parts: list[Message] = BytesParser().parsebytes(head + response.content).get_payload()  # type: ignore[assignment]
    assert [part["content-range"] for part in parts] == [
        f"bytes {r}/{SIZE}" for r in ("0-9", "1000-1099", f"{SIZE - 3}-{SIZE - 1}")
    ]
    boundary = response.headers["content-type"].split("boundary=")[1]
    bodies = [piece.partition(b"\r\n\r\n")[2][:-2] for piece in response.content.split(f"--{boundary}".encode())[1:-1]]
    assert bodies == [WHOLE[:10], WHOLE[1000:1100], WHOLE[-3:]]


@pytest.mark.parametrize("asked", [f"{SIZE}-", f"{SIZE}-{SIZE + 5}", "-0"])
def test_ranges_outside(running: Running, artifact: dict[str, Any], asked: str) -> None:
    response = running.client.get(artifact["url"], headers={"Range": f"bytes={asked}"})
    assert (response.status_code, response.json()["code"]) == (416, "range_not_satisfiable")
    assert response.headers["content-range"] == f"bytes */{SIZE}"


@pytest.mark.parametrize("asked", ["bytes=5-2", "bytes=a-b", "lines=1-2", "bytes=", "bytes=1", "bytes=--1"])
def test_ranges_that_make_no_sense_are_ignored(running: Running, artifact: dict[str, Any], asked: str) -> None:
    response = running.client.get(artifact["url"], headers={"Range": asked})
    assert (response.status_code, response.content) == (200, WHOLE)


def test_conditions(running: Running, artifact: dict[str, Any]) -> None:
    get = running.client.get
    etag = f'"{artifact["sha256"]}"'
    modified = get(artifact["url"]).headers["last-modified"]
    for fresh in ({"If-None-Match": etag}, {"If-None-Match": f'W/"x", {etag}'}, {"If-Modified-Since": modified}):
        response = get(artifact["url"], headers=fresh)
        assert (response.status_code, response.content, response.headers["etag"]) == (304, b"", etag)
    assert get(artifact["url"], headers={"If-None-Match": '"other"'}).status_code == 200
    for same, status in ((etag, 206), (modified, 206), ('"other"', 200), ("Mon, 01 Jan 2001 00:00:00 GMT", 200)):
        assert get(artifact["url"], headers={"Range": "bytes=0-1", "If-Range": same}).status_code == status


def test_names_that_are_no_artifacts(running: Running, artifact: dict[str, Any]) -> None:
    job = artifact["url"].rsplit("/artifacts/", 1)[0]
    for name in ("nope", "..%2F..%2Fgalatea.db", "%2e%2e", "report.json%00"):
        assert running.client.get(f"{job}/artifacts/{name}").status_code == 404


@given(st.text(max_size=30), st.integers(0, 10**6))
def test_any_header_gives_ranges_inside_or_none(text: str, size: int) -> None:
    try:
        ranges = parse_ranges(f"bytes={text}", size)
    except Unsatisfiable:
        return
    assert ranges is None or all(0 <= start < end <= size for start, end in ranges)


@given(st.lists(st.tuples(st.integers(0, 99), st.integers(0, 99)), min_size=1, max_size=16))
def test_ranges_cover_what_was_asked_and_send_nothing_twice(asked: list[tuple[int, int]]) -> None:
    pairs = [(min(pair), max(pair)) for pair in asked]
    ranges = parse_ranges("bytes=" + ",".join(f"{first}-{last}" for first, last in pairs), 100)
    assert ranges is not None
    sent = [byte for start, end in ranges for byte in range(start, end)]
    assert len(sent) == len(set(sent))
    assert set(sent) == {byte for first, last in pairs for byte in range(first, last + 1)}


def test_all_of_them_come_as_one_zip(running: Running, picture: bytes) -> None:
    job = running.until(running.submit(picture)["id"], "succeeded")
    response = running.client.get(f"/v1/jobs/{job['id']}/archive")
    assert response.headers["content-type"] == "application/zip"
    assert f"tiny-{job['id']}.zip" in response.headers["content-disposition"]
    with ZipFile(BytesIO(response.content)) as archive:
        assert archive.testzip() is None
        assert set(archive.namelist()) == set(job["artifacts"])
        for name, artifact in job["artifacts"].items():
            assert hashlib.sha256(archive.read(name)).hexdigest() == artifact["sha256"]


def test_there_is_no_zip_of_a_job_that_goes_on_or_is_not_there(running: Running, picture: bytes) -> None:
    job = running.submit(picture, seconds=3000)
    refused = running.client.get(f"/v1/jobs/{job['id']}/archive")
    assert (refused.status_code, refused.json()["code"]) == (409, "job_not_finished")
    assert running.client.get(f"/v1/jobs/{new_id()}/archive").json()["code"] == "job_not_found"


def test_a_zip_is_made_piece_by_piece(tmp_path: Path) -> None:
    """Its memory is that of a piece, however large the artifacts; other programs can read it."""
    storage = Storage(tmp_path / "storage")
    big = Artifact(id="a" * 36, job_id="j", name="big.bin", content_type="video/mp4", size=40_000_000, sha256="",
                   created_at=datetime.now(UTC))  # fmt: skip
    storage.put(big.key, BytesIO(bytes(big.size)))

    async def pieces() -> list[int]:
        with (tmp_path / "out.zip").open("wb") as file:
            return [file.write(piece) async for piece in zipped([big], storage)]

    assert max(asyncio.run(pieces())) < 3_000_000
    listed = subprocess.run(
        [sys.executable, "-m", "zipfile", "-t", tmp_path / "out.zip"], capture_output=True, text=True
    )
    assert listed.returncode == 0 and "Done testing" in listed.stdout
