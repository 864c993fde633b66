"""Uploads: what is accepted, what is refused at the door, and that nothing of the refused stays."""

from __future__ import annotations

import hashlib
from http.client import HTTPConnection

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from running import Running

from service.files.admission import shown_name


def incoming(running: Running) -> list[str]:
    folder = running.data_dir / "incoming"
    return [path.name for path in folder.iterdir()] if folder.exists() else []


def test_a_file_comes_back_as_it_was_sent(running: Running, picture: bytes) -> None:
    response = running.client.post("/v1/files", files={"file": ("my photo.png", picture, "image/png")})
    assert response.status_code == 201
    file = response.json()
    assert response.headers["location"] == f"/v1/files/{file['id']}"
    assert file["name"] == "my photo.png"
    assert (file["size"], file["content_type"]) == (len(picture), "image/png")
    assert file["sha256"] == hashlib.sha256(picture).hexdigest()
    assert running.client.get(f"/v1/files/{file['id']}").json() == file
    content = running.client.get(f"/v1/files/{file['id']}/content", headers={"Range": "bytes=1-3"})
    assert (content.status_code, content.content) == (206, picture[1:4])
    assert incoming(running) == []


def test_the_content_decides_what_a_file_is(running: Running, picture: bytes) -> None:
    file = running.client.post("/v1/files", files={"file": ("photo.jpg", picture, "image/jpeg")}).json()
    assert file["content_type"] == "image/png"


@pytest.mark.parametrize(
    ("name", "declared", "content", "status", "code"),
    [
        ("empty.png", "image/png", b"", 422, "file_empty"),
        ("notes.txt", "text/plain", b"hello" * 2000, 415, "media_type_unsupported"),
        ("page.jpg", "image/jpeg", b"<html><script>alert(1)</script>", 415, "media_type_unsupported"),
        ("drawing.svg", "image/svg+xml", b"<svg xmlns='http://www.w3.org/2000/svg'/>", 415, "media_type_unsupported"),
        ("sound.mp3", "audio/mpeg", b"ID3" + bytes(5000), 415, "media_type_unsupported"),
        ("one.png", "image/png", b"\x00", 415, "media_type_unsupported"),
    ],
)
def test_what_is_no_picture_or_video_is_refused(
    running: Running, name: str, declared: str, content: bytes, status: int, code: str
) -> None:
    response = running.client.post("/v1/files", files={"file": (name, content, declared)})
    assert (response.status_code, response.json()["code"]) == (status, code)
    assert incoming(running) == []


def test_a_mislabelled_file_is_refused(running: Running, picture: bytes, video: bytes) -> None:
    for content, declared in ((picture, "video/mp4"), (video, "image/jpeg"), (picture, "text/html")):
        response = running.client.post("/v1/files", files={"file": ("a", content, declared)})
        assert (response.status_code, response.json()["code"]) == (415, "media_type_mismatch")


def test_sizes_have_limits_of_their_own(running: Running, picture: bytes, video: bytes) -> None:
    for head, megabytes, status in ((picture, 0.9, 201), (picture, 1.1, 413), (video, 1.1, 201), (video, 2.1, 413)):
        content = head + bytes(int(megabytes * 1e6) - len(head))
        response = running.client.post("/v1/files", files={"file": ("a", content)})
        assert response.status_code == status, response.text
        if status == 413:
            assert response.json()["code"] == "file_too_large"
    assert incoming(running) == []


def test_a_declared_size_beyond_everything_is_refused_before_it_is_sent(running: Running) -> None:
    connection = HTTPConnection(running.client.base_url.host, running.client.base_url.port, timeout=20)
    connection.putrequest("POST", "/v1/files")
    connection.putheader("Content-Type", "multipart/form-data; boundary=x")
    connection.putheader("Content-Length", str(10**12))
    connection.endheaders()
    assert connection.getresponse().status == 413
    connection.close()


@pytest.mark.parametrize(
    ("content_type", "body", "expected"),
    [
        ("application/json", b"{}", (415, "body_type_unsupported")),
        ("multipart/form-data", b"", (422, "invalid_multipart")),
        ("multipart/form-data; boundary=x", b"", (422, "invalid_multipart")),
        ("multipart/form-data; boundary=x", b"garbage", (422, "invalid_multipart")),
        ("multipart/form-data; boundary=x", b"--x\r\n\r\nno name\r\n--x--\r\n", (422, "invalid_multipart")),
        ("multipart/form-data; boundary=x", b"--x--\r\n", (422, "file_missing")),
        (
            "multipart/form-data; boundary=x",
            b'--x\r\nContent-Disposition: form-data; name="file"; filename="a"\r\n\r\n\x89PNG\r\n\x1a\n' + bytes(9000),
            (422, "invalid_multipart"),
        ),
    ],
)
def test_broken_bodies_are_problems(
    running: Running, content_type: str, body: bytes, expected: tuple[int, str]
) -> None:
    response = running.client.post("/v1/files", content=body, headers={"Content-Type": content_type})
    assert (response.status_code, response.json()["code"]) == expected
    assert incoming(running) == []


def test_one_file_at_a_time(running: Running, picture: bytes) -> None:
    response = running.client.post("/v1/files", files=[("file", ("a", picture)), ("file", ("b", picture))])
    assert (response.status_code, response.json()["code"]) == (413, "too_many_files")


def test_hostile_names_are_only_shown(running: Running, picture: bytes) -> None:
    for name in ("../../../../etc/cron.d/x", "..\\..\\boot.ini", "/etc/passwd", "a\x00b.png", '"; rm -rf /', "ü💥.png"):
        file = running.client.post("/v1/files", files={"file": (name, picture)}).raise_for_status().json()
        assert "/" not in file["name"] and "\\" not in file["name"] and file["name"].isprintable()
        sent = running.client.get(f"/v1/files/{file['id']}/content")
        assert sent.content == picture
        assert "\n" not in sent.headers["content-disposition"]
    stored = [path.name for path in (running.data_dir / "storage" / "files").iterdir()]
    assert all(len(name) == 36 for name in stored)


@given(st.text(max_size=400))
def test_a_shown_name_is_never_a_path(name: str) -> None:
    shown = shown_name(name)
    assert 0 < len(shown) <= 255
    assert "/" not in shown and "\\" not in shown and shown.isprintable()


def test_unknown_files_are_problems(running: Running) -> None:
    for path in ("/v1/files/nope", "/v1/files/nope/content", "/v1/files/..%2f..%2fgalatea.db/content"):
        response: httpx.Response = running.client.get(path)
        assert response.status_code == 404
        assert response.headers["content-type"] == "application/problem+json"
