"""Resumable uploads, request by request: what is accepted, what is refused and how, and that nothing of it stays."""

from __future__ import annotations

import base64
import hashlib
import re
import sqlite3
import zlib
from collections.abc import Callable
from contextlib import closing
from datetime import UTC, datetime, timedelta
from email.utils import parsedate_to_datetime

import pytest
from raw_upload import MP4, PIECE, TUS, Media, add, create, standing
from running import Running

MEDIA = Media(300_000)


def b64(text: str | bytes) -> str:
    return base64.b64encode(text.encode() if isinstance(text, str) else text).decode()


def spooled(running: Running) -> list[str]:
    return sorted(path.name for path in (running.data_dir / "uploads").glob("*"))


def problem(response: object) -> tuple[int, str]:
    assert response.headers["content-type"] == "application/problem+json", response.text  # type: ignore[attr-defined]
    assert response.headers["tus-resumable"] == "1.0.0"  # type: ignore[attr-defined]
    return response.status_code, response.json()["code"]  # type: ignore[attr-defined]


def test_the_service_says_what_it_offers(running: Running) -> None:
    for path in ("/v1/uploads", "/v1/uploads/some"):
        response = running.client.options(path)
        assert response.status_code == 204
        assert response.headers["tus-version"] == "1.0.0"
        extensions = set(response.headers["tus-extension"].split(","))
        assert extensions >= {"creation", "termination", "checksum", "expiration", "creation-defer-length"}
        assert response.headers["tus-max-size"] == "2000000"
        assert set(response.headers["tus-checksum-algorithm"].split(",")) == {"sha1", "sha256", "crc32"}


def test_pieces_become_a_file_under_the_same_id_that_a_job_takes(running: Running, picture: bytes) -> None:
    address = create(
        running, len(picture), **{"Upload-Metadata": f"filename {b64('my photo.png')},filetype {b64('image/png')}"}
    )
    half = len(picture) // 2
    first = add(running, address, 0, picture[:half])
    assert (first.status_code, first.headers["upload-offset"]) == (204, str(half))
    upload = running.client.get(address).json()
    assert (upload["status"], upload["offset"], upload["length"], upload["file"]) == (
        *("receiving", half, len(picture)),
        None,
    )
    last = add(running, address, half, picture[half:])
    assert (last.status_code, last.headers["upload-offset"]) == (204, str(len(picture)))
    upload = running.client.get(address).json()
    file = running.client.get(f"/v1/files/{address.rpartition('/')[2]}").json()
    assert (upload["status"], upload["file"]) == ("finished", file)
    assert (file["name"], file["content_type"], file["size"]) == ("my photo.png", "image/png", len(picture))
    assert file["sha256"] == hashlib.sha256(picture).hexdigest()
    assert running.client.get(f"/v1/files/{file['id']}/content").content == picture
    assert file["id"] not in spooled(running)
    job = {"kind": "tiny", "inputs": {"image": file["id"]}}
    done = running.until(running.client.post("/v1/jobs", json=job).raise_for_status().json()["id"], "succeeded")
    report = running.client.get(done["artifacts"]["report.json"]["url"]).json()
    assert report["inputs"]["bytes"] == len(picture)


def test_head_tells_a_finished_upload_from_an_unfinished_one(running: Running) -> None:
    """A client that missed the last answer asks where the upload stands, and need send nothing again."""
    notes = f"filename {b64('a.mp4')},empty,key {b64('ü')}"
    address = create(running, MEDIA.size, **{"Upload-Metadata": notes})
    before = running.client.head(address, headers=TUS)
    assert (before.headers["upload-offset"], before.headers["upload-length"]) == ("0", str(MEDIA.size))
    assert (before.headers["upload-metadata"], before.headers["cache-control"]) == (notes, "no-store")
    lasts = parsedate_to_datetime(before.headers["upload-expires"]) - datetime.now(UTC)
    assert timedelta(hours=23.9) < lasts <= timedelta(hours=24)
    assert add(running, address, 0, MEDIA.bytes()).status_code == 204
    after = running.client.head(address, headers=TUS)
    assert (after.headers["upload-offset"], after.headers["upload-length"]) == (str(MEDIA.size),) * 2
    assert after.headers["upload-metadata"] == notes
    assert "upload-expires" not in after.headers
    assert add(running, address, MEDIA.size, b"").status_code == 204
    assert problem(add(running, address, MEDIA.size, b"x")) == (413, "length_exceeded")
    assert problem(add(running, address, 0, b"x")) == (409, "offset_mismatch")


def test_an_upload_can_be_whole_with_its_first_request(running: Running) -> None:
    headers = PIECE | {"Upload-Length": str(MEDIA.size)}
    response = running.client.post("/v1/uploads", headers=headers, content=MEDIA.bytes())
    assert (response.status_code, response.headers["upload-offset"]) == (201, str(MEDIA.size))
    assert response.json()["file"]["sha256"] == hashlib.sha256(MEDIA.bytes()).hexdigest()


def test_the_length_can_be_told_later_and_then_stands(running: Running) -> None:
    data = MEDIA.bytes()
    address = create(running, None)
    assert running.client.head(address, headers=TUS).headers["upload-defer-length"] == "1"
    assert add(running, address, 0, data[:100_000]).status_code == 204
    assert problem(add(running, address, 100_000, b"", Upload_Length="99999")) == (422, "length_conflict")
    assert add(running, address, 100_000, data[100_000:200_000], Upload_Length=str(MEDIA.size)).status_code == 204
    head = running.client.head(address, headers=TUS).headers
    assert head["upload-length"] == str(MEDIA.size) and "upload-defer-length" not in head
    assert problem(add(running, address, 200_000, b"", Upload_Length=str(MEDIA.size + 1))) == (422, "length_conflict")
    assert add(running, address, 200_000, data[200_000:], Upload_Length=str(MEDIA.size)).status_code == 204
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(data).hexdigest()


def test_the_length_can_be_told_when_all_has_come(running: Running) -> None:
    address = create(running, None)
    assert add(running, address, 0, MEDIA.bytes()).status_code == 204
    assert running.client.get(address).json()["status"] == "receiving"
    assert add(running, address, MEDIA.size, b"", Upload_Length=str(MEDIA.size)).status_code == 204
    assert running.client.get(address).json()["status"] == "finished"


def test_checksums_are_met_or_the_piece_is_not_kept(running: Running) -> None:
    data = MEDIA.bytes()
    address = create(running, MEDIA.size)
    sums: list[tuple[str, Callable[[bytes], bytes]]] = [
        ("sha1", lambda piece: hashlib.sha1(piece).digest()),
        ("sha256", lambda piece: hashlib.sha256(piece).digest()),
        ("crc32", lambda piece: zlib.crc32(piece).to_bytes(4, "big")),
    ]
    for number, (algorithm, digest) in enumerate(sums):
        start, end = 100_000 * number, 100_000 * (number + 1)
        piece = data[start:end]
        wrong = add(running, address, start, piece[:-1] + b"?", Upload_Checksum=f"{algorithm} {b64(digest(piece))}")
        assert problem(wrong) == (460, "checksum_mismatch")
        assert wrong.json()["title"] == "Checksum Mismatch"
        assert standing(running, address) == start
        right = add(running, address, start, piece, Upload_Checksum=f"{algorithm} {b64(digest(piece))}")
        assert right.status_code == 204, right.text
    assert running.client.get(address).json()["file"]["sha256"] == hashlib.sha256(data).hexdigest()


def test_a_damaged_first_piece_is_no_wrong_file(running: Running) -> None:
    address = create(running, MEDIA.size)
    piece = MEDIA.bytes(0, 50_000)
    checksum = f"sha1 {b64(hashlib.sha1(piece).digest())}"
    assert problem(add(running, address, 0, bytes(50_000), Upload_Checksum=checksum)) == (460, "checksum_mismatch")
    assert add(running, address, 0, piece, Upload_Checksum=checksum).status_code == 204


@pytest.mark.parametrize("value", ["md5 " + "A" * 22 + "==", "sha1 !!!", "sha1", "", "sha256 " + b64(bytes(20))])
def test_checksums_that_cannot_be_read_are_refused(running: Running, value: str) -> None:
    address = create(running, MEDIA.size)
    assert problem(add(running, address, 0, MP4, Upload_Checksum=value)) == (400, "checksum_unsupported")


def test_an_upload_can_be_ended(running: Running, picture: bytes) -> None:
    before = spooled(running)
    address = create(running, MEDIA.size)
    add(running, address, 0, MEDIA.bytes(0, 1000))
    assert spooled(running) != before
    assert running.client.delete(address, headers=TUS).status_code == 204
    assert set(spooled(running)) <= set(before)
    for response in (running.client.delete(address, headers=TUS), add(running, address, 1000, b"x")):
        assert problem(response) == (404, "upload_not_found")
    assert running.client.head(address, headers=TUS).status_code == 404


def test_ending_a_finished_upload_erases_the_file_unless_a_job_uses_it(running: Running, picture: bytes) -> None:
    for used in (False, True):
        address = create(running, len(picture))
        add(running, address, 0, picture)
        file = running.client.get(address).json()["file"]["id"]
        if used:
            job = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": file}}).json()["id"]
        assert running.client.delete(address, headers=TUS).status_code == 204
        assert running.client.get(address).status_code == 404
        assert running.client.get(f"/v1/files/{file}").status_code == (200 if used else 404)
    running.until(job, "succeeded")


def test_nothing_is_known_of_an_upload_when_its_file_is_erased(running: Running, picture: bytes) -> None:
    address = create(running, len(picture))
    add(running, address, 0, picture)
    inputs = {"image": address.rpartition("/")[2]}
    job = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": inputs}).json()["id"]
    running.until(job, "succeeded")
    running.client.delete(f"/v1/jobs/{job}").raise_for_status()
    assert running.client.get(address).status_code == 404


def test_what_expired_is_gone(running: Running) -> None:
    """Also before it is erased, which is for housekeeping."""
    address = create(running, MEDIA.size)
    add(running, address, 0, MEDIA.bytes(0, 1000))
    with closing(sqlite3.connect(running.data_dir / "galatea.db", timeout=30)) as database, database:
        of_it = "UPDATE uploads SET expires_at = datetime('now', '-1 minute') WHERE id = ?"
        database.execute(of_it, [address.rpartition("/")[2]])
    for response in (add(running, address, 1000, b"x"), running.client.delete(address, headers=TUS)):
        assert problem(response) == (410, "upload_expired")
    assert running.client.head(address, headers=TUS).status_code == 410
    assert running.client.get(address).json()["code"] == "upload_expired"


def test_each_piece_puts_the_end_off(running: Running) -> None:
    address = create(running, MEDIA.size)
    first = running.client.get(address).json()["expires_at"]
    add(running, address, 0, MEDIA.bytes(0, 1000))
    assert running.client.get(address).json()["expires_at"] > first


@pytest.mark.parametrize(("given", "status"), [({}, 400), ({"Tus-Resumable": "0.2.2"}, 412)])
def test_other_versions_of_the_protocol_are_refused(running: Running, given: dict[str, str], status: int) -> None:
    address = create(running, 10_000)
    for method, path in (("POST", "/v1/uploads"), ("PATCH", address), ("DELETE", address)):
        response = running.client.request(method, path, headers={"Upload-Length": "5", "Upload-Offset": "0"} | given)
        assert problem(response) == (status, "tus_version")
        assert response.headers["tus-version"] == "1.0.0"
    assert running.client.head(address, headers=given).status_code == status
    assert running.client.get(address).status_code == 200, "only tus clients know of versions"


@pytest.mark.parametrize(
    ("headers", "expected"),
    [
        ({}, (422, "length_missing")),
        ({"Upload-Length": "10", "Upload-Defer-Length": "1"}, (422, "length_missing")),
        ({"Upload-Length": "-1"}, (422, "invalid_request")),
        ({"Upload-Length": "ten"}, (422, "invalid_request")),
        ({"Upload-Length": "1" + "0" * 30}, (422, "invalid_request")),
        ({"Upload-Defer-Length": "2"}, (422, "invalid_request")),
        ({"Upload-Length": "0"}, (422, "file_empty")),
        ({"Upload-Length": "2000001"}, (413, "file_too_large")),
        ({"Upload-Length": "1000001", "Upload-Metadata": f"filetype {b64('image/png')}"}, (413, "file_too_large")),
        ({"Upload-Length": "10", "Upload-Metadata": "filename"}, None),
        ({"Upload-Length": "10", "Upload-Metadata": ""}, None),
        ({"Upload-Length": "10", "Upload-Metadata": "filename a"}, (422, "invalid_upload_metadata")),
        ({"Upload-Length": "10", "Upload-Metadata": "filename YQ== YQ=="}, (422, "invalid_upload_metadata")),
        ({"Upload-Length": "10", "Upload-Metadata": "a YQ==,a YQ=="}, (422, "invalid_upload_metadata")),
        ({"Upload-Length": "10", "Upload-Metadata": "a YQ==,,b YQ=="}, (422, "invalid_upload_metadata")),
        ({"Upload-Length": "10", "Upload-Metadata": f"a {b64(bytes([255]))}"}, (422, "invalid_upload_metadata")),
        ({"Upload-Length": "10", "Upload-Metadata": f"a {b64('x' * 9000)}"}, (422, "invalid_upload_metadata")),
    ],
)
def test_uploads_that_cannot_be_are_refused_at_once(
    running: Running, headers: dict[str, str], expected: tuple[int, str] | None
) -> None:
    before = spooled(running)
    response = running.client.post("/v1/uploads", headers=TUS | headers)
    if expected is None:
        assert response.status_code == 201
    else:
        assert problem(response) == expected
        assert set(spooled(running)) <= set(before)


@pytest.mark.parametrize(
    ("first", "declared", "code"),
    [
        (b"<html>" + bytes(5000), "", "media_type_unsupported"),
        (b"ID3" + bytes(5000), "", "media_type_unsupported"),
        (b"short", "", "media_type_unsupported"),
        (MP4 + bytes(5000), "image/png", "media_type_mismatch"),
    ],
)
def test_the_first_bytes_decide_and_nothing_stays_of_what_is_refused(
    running: Running, first: bytes, declared: str, code: str
) -> None:
    before = spooled(running)
    length = len(first) if len(first) < 4096 else 900_000
    address = create(running, length, **({"Upload-Metadata": f"filetype {b64(declared)}"} if declared else {}))
    assert problem(add(running, address, 0, first)) == (415, code)
    assert running.client.get(address).status_code == 404
    assert set(spooled(running)) <= set(before)


def test_sizes_have_limits_of_their_own(running: Running, picture: bytes) -> None:
    """A picture may have 1 MB here, a video 2: which it is shows with the first bytes only."""
    address = create(running, 1_100_000)
    assert problem(add(running, address, 0, picture + bytes(5000))) == (413, "file_too_large")
    assert running.client.get(address).status_code == 404
    address = create(running, 1_100_000)
    assert add(running, address, 0, MEDIA.bytes()).status_code == 204


def test_lies_about_the_length_are_found_out(running: Running) -> None:
    address = create(running, 10_000)
    assert problem(add(running, address, 0, MEDIA.bytes(0, 10_001))) == (413, "length_exceeded")
    assert standing(running, address) == 0

    def pieces() -> object:
        yield MEDIA.bytes(0, 9000)
        yield MEDIA.bytes(9000, 11_000)

    chunked = running.client.patch(address, content=pieces(), headers=PIECE | {"Upload-Offset": "0"})
    assert problem(chunked) == (413, "length_exceeded")
    endless = create(running, None)
    big = running.client.patch(
        endless, content=(MEDIA.bytes() for _ in range(10)), headers=PIECE | {"Upload-Offset": "0"}
    )
    assert problem(big) == (413, "file_too_large")


def test_only_pieces_are_added(running: Running) -> None:
    address = create(running, 10_000)
    response = running.client.patch(address, content=MP4, headers=TUS | {"Upload-Offset": "0"})
    assert problem(response) == (415, "body_type_unsupported")
    response = running.client.patch(address, content=MP4, headers=PIECE)
    assert problem(response) == (422, "invalid_request")
    response = running.client.post("/v1/uploads", json={"a": 1}, headers=TUS | {"Upload-Length": "10"})
    assert problem(response) == (415, "body_type_unsupported")


def test_clients_that_can_only_post_name_their_method(running: Running) -> None:
    address = create(running, 10_000)
    patch = PIECE | {"Upload-Offset": "0", "X-HTTP-Method-Override": "PATCH"}
    response = running.client.post(address, content=MEDIA.bytes(0, 5000), headers=patch)
    assert (response.status_code, response.headers["upload-offset"]) == (204, "5000")
    response = running.client.post(address, headers=TUS | {"X-HTTP-Method-Override": "DELETE"})
    assert response.status_code == 204
    assert running.client.get(address).status_code == 404
    for method in ("GET", "HEAD", "delete"):
        assert running.client.post(address, headers=TUS | {"X-HTTP-Method-Override": method}).status_code == 405
    assert running.client.get("/v1/kinds", headers={"X-HTTP-Method-Override": "DELETE"}).status_code == 200


def test_hostile_names_are_only_shown(running: Running, picture: bytes) -> None:
    for name in ("../../../../etc/cron.d/x", "..\\..\\boot.ini", "a\x00b\r\nc.png", '"; rm -rf /', "ü💥" * 200, " "):
        address = create(running, len(picture), **{"Upload-Metadata": f"filename {b64(name)}"})
        add(running, address, 0, picture)
        file = running.client.get(address).json()["file"]
        assert "/" not in file["name"] and "\\" not in file["name"] and file["name"].isprintable() and file["name"]
        assert running.client.get(f"/v1/files/{file['id']}/content").content == picture
    assert all(re.fullmatch(r"[0-9a-f-]{36}", path.name) for path in (running.data_dir / "storage/files").iterdir())


@pytest.mark.parametrize("name", ["nope", "..%5c..", "00000000-0000-7000-8000-000000000000"])
def test_unknown_uploads_are_problems(running: Running, name: str) -> None:
    address = f"/v1/uploads/{name}"
    assert running.client.head(address, headers=TUS).status_code == 404
    assert problem(add(running, address, 0, b"x")) == (404, "upload_not_found")
    assert problem(running.client.delete(address, headers=TUS)) == (404, "upload_not_found")
    assert running.client.get(address).json()["code"] == "upload_not_found"


def test_an_unfinished_upload_is_no_input(running: Running) -> None:
    address = create(running, MEDIA.size)
    add(running, address, 0, MEDIA.bytes(0, 1000))
    inputs = {"image": address.rpartition("/")[2]}
    response = running.client.post("/v1/jobs", json={"kind": "tiny", "inputs": inputs})
    assert (response.status_code, response.json()["code"]) == (422, "upload_unfinished")
    assert "1000 of 300000 bytes" in response.json()["detail"]
