"""Whatever bytes come, our own readers of them give an answer of their own or a problem with a code, and stay small."""

from __future__ import annotations

import struct
from datetime import UTC, datetime
from pathlib import Path

import anyio
import numpy as np
import pytest
from fastapi import Request
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from engine.errors import InputError
from engine.media.decoding import animated_webp
from engine.media.decoding.demux import open_container
from engine.media.decoding.timing import rate_of
from engine.media.limits import Limits
from engine.media.sniff import IMAGE_TYPES, VIDEO_TYPES, is_still_webp, sniff_bytes
from service.files.admission import shown_name
from service.files.intake import MAX_FIELDS, Form
from service.http.ranges import Unsatisfiable, not_modified, parse_ranges, range_applies
from service.problems import Problem
from service.settings import Settings

MAGIC = [
    b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"GIF89a", b"RIFF\x10\0\0\0WEBP", b"RIFF\xff\xff\xff\xffAVI ", b"acTL",
    b"\x1a\x45\xdf\xa3", b"\x42\x82\x84webm", b"\0\0\0\x18ftyp", b"\xff\xff\xff\xffftypheic", b"qt  ", b"avif", b"IDAT",
    b"VP8X", b"ANMF", b"OggS", b"fLaC", b"ID3",
]  # fmt: skip
files = st.lists(st.one_of(st.sampled_from(MAGIC), st.binary(max_size=40)), max_size=12).map(b"".join)
patiently = settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
ETAG, MODIFIED = '"abc"', datetime(2026, 1, 1, 12, tzinfo=UTC)
headers = st.one_of(
    st.none(), st.text(max_size=60), st.from_regex(r"bytes=[0-9 ,\-]{0,60}", fullmatch=True),
    st.from_regex(r"(Mon|Tue), [0-9]{1,2} (Jan|Feb|Nov) [0-9]{1,5} [0-9]{1,3}:[0-9]{2}:[0-9]{2} ?([+-][0-9]{4}|GMT)?",
                  fullmatch=True),
)  # fmt: skip


@patiently
@given(files)
def test_the_look_at_first_bytes(tmp_path: Path, content: bytes) -> None:
    found = sniff_bytes(content)
    assert found is None or found in IMAGE_TYPES | VIDEO_TYPES or found.startswith("audio/")
    (tmp_path / "file").write_bytes(content)
    is_still_webp(tmp_path / "file")


@patiently
@given(files.map(lambda tail: b"RIFF\xff\xff\xff\xffWEBP" + tail))
@example(b"RIFF\0\0\0\0WEBPVP8X\xff\xff\xff\xff" + bytes(40))
@example(b"RIFF\0\0\0\0WEBP" + b"ANMF\x10\0\0\0" + bytes(16) + b"VP8X\x0a\0\0\0" + b"\xff" * 10)
def test_the_chunks_of_a_webp(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "file.webp"
    path.write_bytes(content)
    try:
        header, timetable = animated_webp.read_chunks(path)
    except InputError as error:
        assert error.code == "video_unreadable"
    else:
        assert 1 <= header.width <= 1 << 24 and len(timetable.times) == header.frames <= len(content) / 24


@patiently
@given(st.sampled_from(sorted(VIDEO_TYPES - {"image/webp"})), files)
def test_opening_a_container(tmp_path: Path, media_type: str, content: bytes) -> None:
    (tmp_path / "file").write_bytes(content)
    try:
        open_container(tmp_path / "file", media_type, Limits()).close()
    except InputError as error:
        assert error.code == "video_unreadable"


@patiently
@given(st.sets(st.integers(-(1 << 62), 1 << 62), min_size=2, max_size=50), st.sampled_from([1, 25, 90_000, 1 << 31]))
@example({0, 1}, 1 << 31)
@example({1 << 62, (1 << 62) + 2048}, 1 << 31)
def test_the_rate_of_any_timestamps(ticks: set[int], clock: int) -> None:
    times = np.unique(np.array(sorted(ticks)) / clock)
    if len(times) > 1:
        assert 0 < rate_of(times).fps < float("inf")


@patiently
@given(headers, st.integers(0, 1 << 40))
def test_ranges(header: str | None, size: int) -> None:
    try:
        ranges = parse_ranges(header, size)
    except Unsatisfiable:
        return
    assert ranges is None or all(0 <= start < end <= size for start, end in ranges)
    assert ranges is None or sum(end - start for start, end in ranges) <= size


@patiently
@given(headers, headers)
@example(None, "Mon, 20 Nov 1995 19:12:08 -0000")
def test_conditions(tags: str | None, moment: str | None) -> None:
    assert not_modified(tags, moment, ETAG, MODIFIED) in (True, False)
    assert range_applies(moment, ETAG, MODIFIED) in (True, False)


@patiently
@given(st.text(max_size=600))
def test_names_that_are_shown(name: str) -> None:
    shown = shown_name(name)
    assert 1 <= len(shown) <= 255 and shown.isprintable() and not set("/\\") & set(shown)
    assert shown_name(shown) == shown


def receive(form_type: str, pieces: list[bytes], folder: Path) -> list[bytes]:
    """The files of a form that comes in these pieces. Raises `Problem`."""
    waiting = [*({"type": "http.request", "body": piece, "more_body": True} for piece in pieces)]
    waiting.append({"type": "http.request", "body": b"", "more_body": False})
    scope = {"type": "http", "method": "POST", "headers": [(b"content-type", form_type.encode("latin-1"))]}

    async def next_piece() -> dict[str, object]:
        return waiting.pop(0)

    async def work() -> list[bytes]:
        async with Form(Request(scope, next_piece), Settings(data_dir=folder, disk_reserve_mb=0), most_files=3) as form:
            return [file.path.read_bytes() for file in form.files]

    return anyio.run(work)


PARTS = [
    b"--edge\r\n", b"--edge--\r\n", b"\r\n", b"\r\n\r\n", b'Content-Disposition: form-data; name="a"', b"; filename=x",
    b'Content-Disposition: form-data; name="a"; filename="b.gif"\r\n\r\nGIF89a', b"Content-Type: image/gif\r\n", b"--",
    b"Content-Disposition: form-data; name=\"\xff\"; filename*=utf-8''%ff", b"\0" * 5000, b"GIF89a", b":", b"\r",
]  # fmt: skip


@patiently
@given(
    st.lists(st.one_of(st.sampled_from(PARTS), st.binary(max_size=60)), max_size=12),
    st.sampled_from(
        ["multipart/form-data; boundary=edge", "multipart/form-data", "multipart/form-data; boundary=\xff"]
    ),
)
def test_forms(tmp_path: Path, pieces: list[bytes], form_type: str) -> None:
    try:
        receive(form_type, pieces, tmp_path)
    except Problem as problem:
        assert 400 <= problem.status < 500
    assert not list(tmp_path.glob("incoming/*")), "nothing is left behind"


@pytest.mark.parametrize("size", [1, 2, 7, 64, 4097])
def test_a_form_is_the_same_in_pieces_of_any_size(tmp_path: Path, size: int) -> None:
    content = b"GIF89a" + bytes(range(256)) * 40 + b"\r\n--edg"
    body = (
        b'--edge\r\nContent-Disposition: form-data; name="file"; filename="a"\r\n\r\n' + content + b"\r\n--edge--\r\n"
    )
    pieces = [body[i : i + size] for i in range(0, len(body), size)]
    assert receive("multipart/form-data; boundary=edge", pieces, tmp_path) == [content]


@pytest.mark.parametrize("length", [0, 7, 8, 0xFFFFFFFF])
def test_a_chunk_that_claims_an_absurd_length_ends_the_file(tmp_path: Path, length: int) -> None:
    path = tmp_path / "file.webp"
    path.write_bytes(b"RIFF\0\0\0\0WEBPANMF" + struct.pack("<I", length))
    with pytest.raises(InputError):
        animated_webp.read_chunks(path)


def taken(form_type: str, pieces: list[bytes], folder: Path) -> tuple[Problem, int]:
    """The problem that a form is, and how many of its pieces had been taken by then."""
    waiting = [{"type": "http.request", "body": piece, "more_body": True} for piece in pieces]
    scope = {"type": "http", "method": "POST", "headers": [(b"content-type", form_type.encode("latin-1"))]}
    count = 0

    async def next_piece() -> dict[str, object]:
        nonlocal count
        count += 1
        return waiting[count - 1]

    async def work() -> Problem:
        with pytest.raises(Problem) as caught:
            async with Form(Request(scope, next_piece), Settings(data_dir=folder, disk_reserve_mb=0), 3, ("options",)):
                pass
        return caught.value

    return anyio.run(work), count


def part(name: str, content: bytes = b"x", more: str = "") -> bytes:
    return f'--edge\r\nContent-Disposition: form-data; name="{name}"{more}\r\n\r\n'.encode() + content + b"\r\n"


@pytest.mark.parametrize(
    ("pieces", "status", "code", "most"),
    [
        ([part(f"f{i}") for i in range(30_000)], 413, "too_many_parts", MAX_FIELDS + 1),
        ([part("f", b"", '; filename=""') for _ in range(30_000)], 413, "too_many_parts", MAX_FIELDS + 1),
        ([part("f", b"GIF89a", '; filename="a"') for _ in range(30_000)], 413, "too_many_files", 4),
        ([b"--edge\r\n", *(b"X-%d: a\r\n" % i for i in range(30_000))], 413, "part_head_too_large", 11),
        ([b"--edge\r\nX: ", *[b"a" * 1000] * 30_000], 413, "part_head_too_large", 6),
        ([b"--edge\r\n", *[b"X" * 1000] * 30_000], 413, "part_head_too_large", 6),
        ([part("options")[:-3], *[b"1" * 10_000] * 30_000], 413, "request_too_large", 102),
        ([part(f"f{i}", b"x" * 3000) for i in range(90)] + [part("options", b"1" * 800_000)], 413, "request_too_large", 91),
    ],
    ids=["fields", "files not chosen", "files", "headers", "a header's value", "a header's name", "a text", "texts"],
)  # fmt: skip
def test_a_form_is_refused_before_the_rest_of_it_has_come(
    tmp_path: Path, pieces: list[bytes], status: int, code: str, most: int
) -> None:
    problem, count = taken("multipart/form-data; boundary=edge", pieces, tmp_path)
    assert (problem.status, problem.code) == (status, code)
    assert count <= most
