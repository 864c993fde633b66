"""What strangers send: requests that cost a service far more than they cost whoever sends them, or that it cannot
take at all. Each is made here by hand or from a count; nothing comes from elsewhere.

`benchmarks.hostile_bodies` sends them at a service that runs; tests hold that each is refused.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from io import BytesIO

from PIL import Image

UNKNOWN_ID = "00000000-0000-7000-8000-000000000000"
"""An id that nothing has."""


@dataclass(frozen=True)
class Sent:
    """One request. `pieces` are sent one by one."""

    what: str
    method: str
    path: str
    pieces: tuple[bytes, ...] = ()
    headers: dict[str, str] = field(default_factory=dict)
    chunked: bool = False
    """Whether each piece is a chunk of its own, so that no length is told before."""


def strangers() -> Iterator[Sent]:
    """All of them."""
    yield from forms()
    yield from documents()
    yield from options()
    yield from corrections()
    yield from texts()
    yield from heads()
    yield from pieces()


def part(head: str, content: bytes = b"x") -> bytes:
    """A part of a form with its boundary before it."""
    return b"--edge\r\nContent-Disposition: form-data; " + head.encode("latin-1") + b"\r\n\r\n" + content + b"\r\n"


def form(what: str, parts: Iterable[bytes], path: str = "/v1/jobs", boundary: str = "edge") -> Sent:
    body = b"".join(parts) + b"--edge--\r\n"
    return Sent(what, "POST", path, (body,), {"Content-Type": f"multipart/form-data; boundary={boundary}"})


def document(what: str, content: object, path: str = "/v1/jobs", method: str = "POST") -> Sent:
    """A JSON body; bytes are sent as they are."""
    body = content if isinstance(content, bytes) else json.dumps(content).encode()
    return Sent(what, method, path, (body,), {"Content-Type": "application/json"})


def picture() -> bytes:
    file = BytesIO()
    Image.new("RGB", (30, 20), (90, 120, 150)).save(file, "PNG")
    return file.getvalue()


def forms() -> Iterator[Sent]:
    """Multipart bodies."""
    png = picture()
    for path in ("/v1/jobs", "/v1/files", "/v1/drivers", f"/v1/jobs/{UNKNOWN_ID}/revisions"):
        yield form(f"30,000 fields to {path}", [part(f'name="f{i}"') for i in range(30_000)], path)
    yield form("30,000 fields of one name", [part('name="f"') for _ in range(30_000)])
    yield form("30,000 files", [part('name="image"; filename="a.png"', png[:9]) for _ in range(30_000)])
    yield form("30,000 empty files without a name", [part('name="image"; filename=""', b"") for _ in range(30_000)])
    yield form("one field of 1 MB in bytes", [part('name="options"', b"1" * 1_000_001)])
    yield form("names of 4 kB", [part(f'name="{i}{"n" * 4000}"') for i in range(200)])
    yield form("a part with 1,000 headers", [b"--edge\r\n" + b"".join(b"X-%d: a\r\n" % i for i in range(1000))])
    yield form("a header of a part that never ends", [b"--edge\r\nX: " + b"a" * 1_000_000])
    yield form("parts whose head is parameters", [part('name="a"' + ";" * 4000) for _ in range(200)])
    yield form("a line end at each place", [part('name="image"; filename="a"', b"\r\n--edg" * 200_000)])
    yield form("carriage returns", [part('name="image"; filename="a.png"', png + b"\r" * 900_000)])
    yield form("a beginning before the first boundary", [b"\r\n" * 500_000, part('name="kind"')])
    yield form("much after the end", [b"--edge--\r\n", b"-" * 3_000_000])
    yield form("a boundary of 300 bytes", [part('name="kind"')], boundary="e" * 300)
    yield form("a boundary of 60,000 bytes", [part('name="kind"')], boundary="e" * 60_000)
    yield form("a content type of semicolons", [part('name="kind"')], boundary="edge" + ";" * 60_000)
    yield form("a content type of quotes", [part('name="kind"')], boundary='edge;"' + ";" * 60_000)
    yield form("a NUL in a text", [part('name="kind"', b"tiny"), part('name="image"', b"a\0b")])
    yield form("bytes that are no text", [part('name="kind"', b"\xff\xfe")])
    yield form("names that are no text", [part('name="\xff\xfe\xed\xa0\x80"'), part('name="kind"', b"tiny")])
    yield form("deep JSON in a part", [part('name="kind"', b"tiny"), part('name="options"', b"[" * 100_000)])
    halves = [b"--edge\r\nContent-Disposition: form-data; name=\"metadata\"\r\n\r\n", *[b"1"] * 100_000]  # fmt: skip
    yield Sent(
        "a field in chunks of one byte", "POST", "/v1/jobs", tuple(halves),
        {"Content-Type": "multipart/form-data; boundary=edge"}, chunked=True,
    )  # fmt: skip


def documents() -> Iterator[Sent]:
    """JSON bodies of any endpoint that takes one."""
    many = {f"unknown-{i}": i for i in range(60_000)}
    some = {f"u{i}": i for i in range(3000)}
    for method, path in (
        ("POST", "/v1/jobs"), ("POST", "/v1/webhooks"), ("POST", "/v1/keys"), ("POST", "/v1/drivers"),
        ("POST", "/v1/motions"), ("POST", "/v1/session"), ("POST", f"/v1/jobs/{UNKNOWN_ID}/links"),
        ("POST", f"/v1/jobs/{UNKNOWN_ID}/revisions"), ("PATCH", f"/v1/webhooks/{UNKNOWN_ID}"),
    ):  # fmt: skip
        yield document(f"60,000 unknown names to {path}", many, path, method)
        yield document(f"3,000 unknown names to {path}", some, path, method)
        yield document(f"one name of 900 kB to {path}", {"n" * 900_000: 1}, path, method)
        yield document(f"deep arrays to {path}", b"[" * 500_000, path, method)
        yield document(f"400 deep to {path}", {"metadata": {"a": nested(400)}, "kind": "tiny"}, path, method)
        yield document(
            f"a whole number of 100,000 digits to {path}", b'{"kind": 1' + b"0" * 100_000 + b"}", path, method
        )
        yield document(f"half a character as a name to {path}", b'{"\\ud800": 1}', path, method)
        yield document(f"half a character to {path}", b'{"kind": "\\ud800", "name": "\\udfff"}', path, method)
        yield document(f"a NUL to {path}", b'{"kind": "a\\u0000b", "name": "a\\u0000b"}', path, method)
        yield document(f"no object to {path}", b'"text"', path, method)
        yield document(f"2 MB to {path}", b'{"kind": "' + b"a" * 2_000_000 + b'"}', path, method)
        yield document(f"an infinite number to {path}", b'{"kind": "tiny", "name": 1e999}', path, method)
    scattered = tuple(b"[" if i == 0 else b"1," for i in range(100_000))
    yield Sent(
        "JSON in chunks of two bytes", "POST", "/v1/jobs", scattered, {"Content-Type": "application/json"}, chunked=True
    )


def nested(depth: int) -> object:
    value: object = 1
    for _ in range(depth):
        value = [value]
    return value


def options() -> Iterator[Sent]:
    """Options and inputs of jobs."""
    big = 2**70
    portrait = {
        "face_index": big, "driver_face_index": big, "neutral_frame": big, "size": [big, big], "trim": [0, 1e308],
        "fps": 10**400, "reactive": ["happy"] * 70_000, "follow": ["x"] * 150_000, "landmarks": ["x"] * 150_000,
        "crop": [0] * 200_000, "strength": "1" * 5000, "n" * 800_000: 1,
    }  # fmt: skip
    character = {
        "person_index": big, "triangles": big, "levels": big, "keep": ["head"] * 90_000,
        "pose": {f"j{i}": [0, 0, 0] for i in range(900)}, "joints": {f"j{i}": 0 for i in range(40_000)},
        "mask_strokes": [{"path": ["x"] * 5000, "radius": 1, "person": True}] * 40,
        "label_strokes": [{f"u{i}": 1 for i in range(500)}] * 150, "motion_joints": {"a" * 400_000: "b" * 400_000},
        "motion_clip": "c" * 900_000, "vrm_author": "\0", "person_box": [1e999, 0, 1, 1],
    }  # fmt: skip
    for kind, media, offered in (("portrait", "image", portrait), ("character", "photo", character)):
        for name, value in offered.items():
            asked = {"kind": kind, "inputs": {media: UNKNOWN_ID}, "options": {name: value}}
            text = json.dumps(asked).replace("Infinity", "1e999")
            yield document(f"{kind}: {name[:40]}", text.encode())
        asked = {"kind": kind, "options": {f"strngth{i}": 1 for i in range(40_000)}}
        yield document(f"{kind}: 40,000 unknown options", asked)
        asked = {"kind": kind, "options": {f"strngth{i}": 1 for i in range(900)}}
        yield document(f"{kind}: 900 unknown options", asked)
    inputs: dict[str, object] = {
        "60,000 inputs": {f"i{i}": "a" for i in range(60_000)},
        "900 inputs": {f"i{i}": "a" for i in range(900)},
        "wrong inputs": {"image": [1] * 300_000},
        "an input of many files": {"image": ["a"] * 200_000},
        "an address of 900 kB": {"image": "https://" + "a." * 450_000 + "example"},
        "an address of 900 kB without dots": {"image": "https://" + "a" * 900_000},
        "a name of 900 kB": {"image": "a" * 900_000},
        "slashes": {"image": UNKNOWN_ID, "driver": "a/" * 400_000},
    }
    for what, given in inputs.items():
        yield document(what, {"kind": "portrait", "inputs": given})
    for what, notes in {
        "metadata of 900 kB": {"a": "b" * 900_000},
        "metadata 300 deep": {"a": nested(300)},
        "metadata with a number of 4,000 digits": {"a": 10**4000},
        "metadata with lines": {"a": [1] * 300_000},
    }.items():
        yield document(what, {"kind": "portrait", "inputs": {"image": UNKNOWN_ID}, "metadata": notes})
    yield document("metadata with an infinite number", b'{"kind": "portrait", "metadata": {"a": -1e999}}')
    yield document("100,000 events", {"kind": "portrait", "webhook_events": ["job.succeeded"] * 50_000})


def corrections() -> Iterator[Sent]:
    """Revisions."""
    path = f"/v1/jobs/{UNKNOWN_ID}/revisions"
    yield document("60,000 corrections", {"corrections": {f"c{i}": 1 for i in range(60_000)}}, path)
    yield document("a correction 400 deep", {"corrections": {"joints": nested(400)}}, path)
    yield document("a correction's name with a NUL", b'{"corrections": {"a\\u0000": 1}}', path)


def texts() -> Iterator[Sent]:
    """Queries and paths."""
    for name in ("status", "kind", "limit", "cursor", "created_after"):
        yield Sent(f"a query of many {name}", "GET", "/v1/jobs?" + "&".join([f"{name}=x"] * 5000))
    yield Sent("a query of many unknown names", "GET", "/v1/jobs?" + "&".join(f"u{i}" for i in range(9000)))
    for text in ("%00", "%ed%a0%80", "%ff", "%F0%9F", "a" * 50_000, "9" * 50_000):
        for name in ("status", "kind", "limit", "cursor", "created_after", "created_before"):
            yield Sent(f"{name}={text[:12]}", "GET", f"/v1/jobs?{name}={text}")
        for name in ("job", "webhook", "event", "status", "cursor"):
            yield Sent(f"deliveries {name}={text[:12]}", "GET", f"/v1/webhooks/deliveries?{name}={text}")
        for path in (
            "/v1/jobs/{}", "/v1/files/{}", "/v1/files/{}/content", "/v1/drivers/{}", "/v1/motions/{}", "/v1/public/{}",
            "/v1/uploads/{}", "/v1/jobs/{}/artifacts/{}", "/v1/jobs/{}/events?after={}", "/{}", "/assets/{}", "/v1/keys/{}",
            "/v1/webhooks/{}", "/v1/webhooks/deliveries/{}", "/v1/jobs/a/artifacts/b?expires={}&signature={}",
            "/v1/drivers/{}/video", "/v1/drivers/idle/moments/{}/poster", "/v1/jobs/{}/links", "/v1/public/{}/{}",
        ):  # fmt: skip
            shown = text if path.count("{}") == 1 else text[:20_000]
            yield Sent(f"{path} of {text[:12]}", "GET", path.replace("{}", shown))


def heads() -> Iterator[Sent]:
    """Headers, 60 kB of them at most: the server itself ends a longer head."""
    job = json.dumps({"kind": "tiny"}).encode()
    for name, value in (
        ("Idempotency-Key", "k" * 60_000), ("Idempotency-Key", "\xff\xfe"), ("Idempotency-Key", ""),
        ("Prefer", "wait" + " " * 60_000), ("Prefer", "wait=" * 12_000), ("Prefer", ",wait=\xb2\xb3"),
        ("Prefer", "wait=" + "9" * 60_000), ("Traceparent", "00-" + "a" * 60_000), ("X-Request-Id", "\xff" * 60_000),
        ("Authorization", "Bearer " + "\xff" * 60_000), ("Authorization", "Bearer " + " " * 60_000),
        ("Cookie", "galatea_session=" + "a" * 60_000), ("Cookie", ";" * 60_000), ("Cookie", 'a="' + "\\" * 60_000),
        ("Origin", "http://[" + "a" * 60_000), ("Origin", "http://\u2100".encode().decode("latin-1")),
        ("X-Forwarded-For", "a" * 60_000), ("Accept", "*/*," * 15_000), ("Content-Type", ";" * 60_000),
        ("Content-Type", "application/json" + ";" * 60_000), ("Content-Type", 'application/json;"' + ";" * 60_000),
        ("Content-Type", "application/json; charset=\xff"),
    ):  # fmt: skip
        yield Sent(
            f"{name}: {value[:20]!r}", "POST", "/v1/jobs", (job,), {"Content-Type": "application/json", name: value}
        )
    for kind in ('application/json;"' + ";" * 60_000, "application/json" + ";" * 60_000, "\xff/json"):
        yield Sent(f"a webhook as {kind[:20]!r}", "POST", "/v1/webhooks", (b"{}",), {"Content-Type": kind})
    for name, value in (
        ("Range", "bytes=" + "0-0," * 15_000), ("Range", "bytes=" + "0-" + "9" * 60_000), ("Range", "bytes=\xb2-\xb3"),
        ("If-None-Match", '"a",' * 15_000), ("If-Modified-Since", "9" * 60_000), ("If-Modified-Since", "Mon, " * 12_000),
        ("If-Range", "1 Jan 99999999999 00:00:00"), ("If-Modified-Since", "Mon, 1 Jan 2020 00:00:00 " + "(" * 50_000),
    ):  # fmt: skip
        yield Sent(f"{name}: {value[:20]!r}", "GET", "/v1/drivers/happy/poster", (), {name: value})
        yield Sent(f"{name}: {value[:20]!r} of a page", "GET", "/index.html", (), {name: value})


def pieces() -> Iterator[Sent]:
    """Resumable uploads."""
    tus = {"Tus-Resumable": "1.0.0", "Upload-Length": "100"}
    for value in (
        "," * 7900,
        "a " * 3900,
        "a" * 60_000,
        "filename " + "=" * 7000,
        "filename AAAA",
        "filename 7aCA",
        "\xff YQ==",
    ):
        yield Sent(f"Upload-Metadata: {value[:20]!r}", "POST", "/v1/uploads", (), {**tus, "Upload-Metadata": value})
    for name, value in (
        ("Upload-Length", "9" * 60_000), ("Upload-Length", "-1"), ("Upload-Length", "\xb2"), ("Upload-Length", str(2**70)),
        ("Upload-Defer-Length", "9" * 5000), ("Upload-Checksum", "sha1 " + "A" * 60_000), ("Upload-Checksum", "\xff"),
        ("Tus-Resumable", "9" * 60_000), ("X-HTTP-Method-Override", "P" * 60_000),
    ):  # fmt: skip
        yield Sent(f"{name}: {value[:20]!r}", "POST", "/v1/uploads", (), {**tus, name: value})
    yield Sent(
        "Upload-Offset of 60,000 digits", "PATCH", f"/v1/uploads/{UNKNOWN_ID}", (b"a",),
        {**tus, "Upload-Offset": "9" * 60_000, "Content-Type": "application/offset+octet-stream"},
    )  # fmt: skip
    yield Sent(
        "a piece in chunks of one byte", "POST", "/v1/uploads", (b"a",) * 100_000,
        {"Tus-Resumable": "1.0.0", "Upload-Defer-Length": "1", "Content-Type": "application/offset+octet-stream"},
        chunked=True,
    )  # fmt: skip
