"""Forms as ordinary clients send them: fields left empty, files without a name, JSON as a file of the browser's."""

from __future__ import annotations

from typing import Any

import httpx
import pytest
from made_motion import bvh
from running import Running

NOT_CHOSEN = ("", b"", "application/octet-stream")
"""What every browser sends for `<input type=file>` where no file was chosen, and curl for `-F 'a=@/dev/null;filename='`."""


def submitted(running: Running, *parts: tuple[str, Any], path: str = "/v1/jobs") -> httpx.Response:
    """A form, part by part: (name, (file name or None, content, media type or None))."""
    lines = []
    for name, (filename, content, declared) in parts:
        given = f'; filename="{filename}"' if filename is not None else ""
        kind = f"\r\nContent-Type: {declared}" if declared is not None else ""
        lines.append(f'--edge\r\nContent-Disposition: form-data; name="{name}"{given}{kind}\r\n\r\n'.encode() + content)
    body = b"\r\n".join([*lines, b"--edge--\r\n"])
    return running.client.post(path, content=body, headers={"Content-Type": "multipart/form-data; boundary=edge"})


def text(value: str) -> tuple[None, bytes, None]:
    return None, value.encode(), None


TINY = ("kind", text("tiny"))


def test_a_file_that_was_not_chosen_is_not_given(running: Running, picture: bytes) -> None:
    sent = submitted(running, TINY, ("image", ("a.png", picture, None)), ("driver", NOT_CHOSEN), ("mask", NOT_CHOSEN))
    assert sent.status_code == 202 and list(sent.json()["inputs"]) == ["image"]


@pytest.mark.parametrize(
    "name", ["options", "metadata", "webhook_url", "webhook_events", "priority", "inputs", "driver"]
)
def test_an_empty_text_is_not_given(running: Running, picture: bytes, name: str) -> None:
    sent = submitted(running, TINY, ("image", ("a.png", picture, None)), (name, text("")))
    assert sent.status_code == 202, sent.text
    assert (sent.json()["options"], sent.json()["metadata"], sent.json()["priority"]) == ({}, {}, "normal")


def test_what_must_be_given_is_missing_where_it_is_empty(running: Running) -> None:
    for empty in (NOT_CHOSEN, text("")):
        assert submitted(running, TINY, ("image", empty)).json()["code"] == "missing_input"
        assert submitted(running, ("file", empty), path="/v1/files").json()["code"] == "file_missing"
        sent = submitted(running, ("name", text("one")), ("file", empty), path="/v1/drivers")
        assert sent.json()["code"] == "file_missing"
    assert submitted(running, ("kind", text(""))).json()["errors"][0]["pointer"] == "/kind"


def test_a_file_with_a_name_and_no_bytes_is_a_mistake(running: Running) -> None:
    sent = submitted(running, TINY, ("image", ("a.png", b"", "image/png")))
    assert (sent.status_code, sent.json()["code"]) == (422, "file_empty")


@pytest.mark.parametrize("declared", [None, "image/png", "application/octet-stream"])
@pytest.mark.parametrize("filename", [None, ""])
def test_a_part_with_a_files_content_is_a_file_also_without_a_name(
    running: Running, picture: bytes, filename: str | None, declared: str | None
) -> None:
    sent = submitted(running, TINY, ("image", (filename, picture, declared)))
    assert sent.status_code == 202, sent.text
    file = running.client.get(f"/v1/files/{sent.json()['inputs']['image']}").json()
    assert (file["size"], file["content_type"], file["name"]) == (len(picture), "image/png", "unnamed")
    sent = submitted(running, ("file", (filename, picture, declared)), path="/v1/files")
    assert (sent.status_code, sent.json()["size"]) == (201, len(picture))


def test_a_file_of_text_is_a_file_also_without_a_name(running: Running) -> None:
    motion = bvh(frames=2)
    sent = submitted(running, ("name", text("nameless")), ("file", (None, motion, None)), path="/v1/motions")
    assert (sent.status_code, sent.json()["size"]) == (201, len(motion))
    small = motion[:300]
    assert submitted(running, TINY, ("image", (None, small, None))).json()["code"] == "input_wrong_media"


def test_a_text_stays_one_whatever_it_looks_like(running: Running, picture: bytes) -> None:
    """As a movie's first bytes may read: four characters, then `free`."""
    sent = submitted(running, TINY, ("image", ("a.png", picture, None)), ("driver", text("carefree-dance")))
    assert sent.json()["code"] == "unknown_driver"
    sent = submitted(running, TINY, ("image", (None, b"\xc3\xbc" * 1999, "text/plain; charset=utf-8")))
    assert sent.json()["code"] == "unknown_file"


def test_json_may_come_as_a_file_of_the_browsers(running: Running, picture: bytes) -> None:
    """`form.append("options", new Blob([json], {type: "application/json"}))` names it “blob”."""
    options = ("blob", b'{"seconds": 0}', "application/json")
    sent = submitted(running, TINY, ("options", options), ("image", ("blob", picture, "image/png")))
    assert (sent.status_code, sent.json()["options"]) == (202, {"seconds": 0})


def test_what_comes_after_the_last_part_is_nobodys(running: Running, picture: bytes) -> None:
    body = b'--edge\r\nContent-Disposition: form-data; name="file"; filename="a"\r\n\r\n' + picture
    body += b"\r\n--edge--\r\n" + b"-" * 300_000
    headers = {"Content-Type": "multipart/form-data; boundary=edge"}
    for _ in range(2):  # the line is good for another request
        sent = running.client.post("/v1/files", content=body, headers=headers)
        assert (sent.status_code, sent.json()["size"]) == (201, len(picture))


@pytest.mark.parametrize("length", [257, 900, 5000])
def test_a_boundary_that_is_too_long_is_refused(running: Running, length: int) -> None:
    headers = {"Content-Type": f"multipart/form-data; boundary={'e' * length}"}
    sent = running.client.post("/v1/files", content=b"--" + b"e" * length, headers=headers)
    assert (sent.status_code, sent.json()["code"]) == (422, "invalid_multipart")


def test_an_unknown_part_is_refused_at_once(running: Running, picture: bytes) -> None:
    sent = submitted(running, ("n" * 3000, text("x")), ("file", ("a", picture, None)), path="/v1/files")
    assert (sent.status_code, sent.json()["code"]) == (422, "unknown_part")
    assert len(sent.content) < 1000
