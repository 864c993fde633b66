"""Broken and malicious files, made from a seed: nothing here comes from elsewhere.

Small honest files are written by the usual libraries and then spoilt (cut, bits turned, sizes and counts replaced);
the rest is built by hand: bombs, files that are two things at once, playlists in disguise, names that are traps.
"""

from __future__ import annotations

import io
import random
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import av
import numpy as np
import pillow_heif
from PIL import Image

Role = Literal["image", "video"]


@dataclass(frozen=True)
class Specimen:
    """A file as a client would send it, and what it is then used as."""

    what: str
    content: bytes
    role: Role
    name: str = "file"
    declared: str = "application/octet-stream"


def corpus(seed: int, folder: Path) -> list[Specimen]:
    """All of them; `folder` is a place for passing files. Each honest file is spoilt in every other way, its neighbour
    in those between; with the next seed the other way round."""
    honest = [*honest_images(), *honest_videos(folder)]
    mp4 = next(one for one in honest if one.what == "mp4")
    made = [
        *(
            spoilt
            for i, one in enumerate(honest)
            for spoilt in list(spoil(one, random.Random(seed * 1000 + i)))[(seed + i) % 2 :: 2]
        ),
        *bent_boxes(mp4, random.Random(seed)),
        *bombs(),
        *polyglots(honest),
        *impostors(),
        *strange_names(honest),
        *wrong_declarations(honest),
    ]
    return [*honest, *made]


def _picture(size: tuple[int, int] = (48, 40), shift: int = 0) -> Image.Image:
    y, x = np.mgrid[: size[1], : size[0]]
    return Image.fromarray(np.stack([x * 5 + shift, y * 6, (x + y) * 2], -1).astype(np.uint8))


def honest_images() -> Iterator[Specimen]:
    pillow_heif.register_heif_opener()
    exif = Image.Exif()
    exif[0x0112], exif[0x010E] = 6, "a picture"
    frames = [_picture(shift=40 * i) for i in range(4)]
    for format_, options in (
        ("JPEG", {"exif": exif}), ("PNG", {}), ("WEBP", {}), ("GIF", {}), ("AVIF", {}), ("HEIF", {}),
    ):  # fmt: skip
        yield Specimen(format_.lower(), _saved(frames[0], format_, **options), "image")
    several = {"save_all": True, "append_images": frames[1:], "duration": 100}
    for format_, what in (("GIF", "moving gif"), ("WEBP", "moving webp"), ("PNG", "moving png")):
        yield Specimen(what, _saved(frames[0], format_, **several), "video")


def _saved(image: Image.Image, format_: str, **options: object) -> bytes:
    file = io.BytesIO()
    image.save(file, format_, **options)
    return file.getvalue()


def honest_videos(folder: Path) -> Iterator[Specimen]:
    for what, codec, options in (
        ("mp4", "libx264", {}), ("mov", "libx264", {}), ("mkv", "libx264", {}), ("webm", "libvpx-vp9", {}),
        ("avi", "mpeg4", {}), ("fragmented mp4", "libx264", {"movflags": "frag_keyframe+empty_moov"}),
    ):  # fmt: skip
        path = folder / f"honest.{what.split()[-1]}"
        with av.open(str(path), "w", options=options) as container:
            stream = container.add_stream(codec, rate=10)
            stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
            for i in range(8):
                picture = np.asarray(_picture((64, 48), 20 * i))
                container.mux(stream.encode(av.VideoFrame.from_ndarray(picture)))
            container.mux(stream.encode(None))
        yield Specimen(what, path.read_bytes(), "video")


def spoil(one: Specimen, rng: random.Random) -> Iterator[Specimen]:
    """The file cut, with bits turned, with numbers replaced, with parts doubled, and followed by noise."""

    def spoilt(how: str, content: bytes) -> Specimen:
        return Specimen(f"{one.what}, {how}", content, one.role)

    data = one.content
    for share in (0.02, 0.5, 0.97):
        yield spoilt(f"cut at {share:.0%}", data[: max(16, int(len(data) * share))])
    for count in (1, 4, 32):
        turned = bytearray(data)
        for _ in range(count):
            turned[rng.randrange(12, len(data))] ^= 1 << rng.randrange(8)
        yield spoilt(f"{count} bits turned", bytes(turned))
    for value in (0, 0x7FFFFFFF, 0xFFFFFFFF):
        place = rng.randrange(12, max(13, min(len(data) - 4, 600)))
        number = struct.pack(rng.choice((">I", "<I")), value)
        yield spoilt(f"{value:#x} at {place}", data[:place] + number + data[place + 4 :])
    start, length = rng.randrange(12, len(data) // 2), rng.randrange(8, len(data) // 3)
    yield spoilt("part doubled", data[: start + length] + data[start:])
    yield spoilt("part missing", data[:start] + data[start + length :])
    yield spoilt("noise behind", data + rng.randbytes(5000))
    yield spoilt("zeros within", data[:start] + bytes(length) + data[start + length :])


def bent_boxes(mp4: Specimen, rng: random.Random) -> Iterator[Specimen]:
    """An MP4 whose boxes keep their places but claim the absurd."""
    absurd = [0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x00010000]
    # (box, offset behind its name, what the number there is)
    numbers = [
        ("mvhd", 12, "time scale"), ("mvhd", 16, "duration"), ("mvhd", 36, "matrix"), ("tkhd", 40, "matrix"),
        ("tkhd", 44, "matrix"), ("tkhd", 76, "width"), ("tkhd", 80, "height"), ("mdhd", 12, "time scale"),
        ("mdhd", 16, "duration"), ("stts", 4, "entries"), ("stts", 8, "count"), ("stts", 12, "step"),
        ("stsz", 4, "size"), ("stsz", 8, "count"), ("stsz", 12, "first size"), ("stsc", 4, "entries"),
        ("stsc", 12, "samples"), ("stco", 4, "entries"), ("stco", 8, "offset"), ("elst", 4, "entries"),
        ("elst", 8, "length"), ("elst", 12, "time"), ("elst", 16, "rate"), ("ctts", 4, "entries"),
        ("stsd", 4, "entries"), ("avc1", 24, "width and height"), ("stss", 4, "entries"), ("dref", 4, "entries"),
    ]  # fmt: skip
    for box, offset, meaning in numbers:
        place = mp4.content.find(box.encode())
        if place < 0:
            continue
        place += 4 + offset
        value = rng.choice(absurd)
        content = mp4.content[:place] + struct.pack(">I", value) + mp4.content[place + 4 :]
        yield Specimen(f"mp4 whose {box} claims {value:#x} as its {meaning}", content, "video")
    for box in ("moov", "trak", "mdia", "minf", "stbl", "stsd", "avcC", "mdat"):
        place = mp4.content.find(box.encode()) - 4
        for size in (0, 7, 0xFFFFFFFF):
            content = mp4.content[:place] + struct.pack(">I", size) + mp4.content[place + 4 :]
            yield Specimen(f"mp4 whose {box} has the size {size:#x}", content, "video")
    nested = mp4.content[:32]
    for _ in range(20_000):
        nested += struct.pack(">I", 0x7FFFFFFF) + b"moov"
    yield Specimen("mp4 with boxes 20,000 deep", nested, "video")
    # A data reference that names another file, as QuickTime's aliases and addresses do.
    url = struct.pack(">I4sI", 12 + 12, b"url ", 0) + b"/etc/passwd\0"
    dref = mp4.content.find(b"url ") - 4
    yield Specimen("mp4 whose data lie elsewhere", mp4.content[:dref] + url[:12] + mp4.content[dref + 12 :], "video")


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def _png(width: int, height: int, *chunks: bytes, depth: int = 8, colour: int = 2, interlace: int = 0) -> bytes:
    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + b"".join(chunks) + _chunk(b"IEND", b"")


def _zeros(count: int) -> bytes:
    packer = zlib.compressobj(9)
    block = bytes(1 << 20)
    whole = [packer.compress(block) for _ in range(count >> 20)]
    return b"".join([*whole, packer.compress(bytes(count & ((1 << 20) - 1))), packer.flush()])


def bombs() -> Iterator[Specimen]:
    """Small files that want to become large."""
    many = _zeros(120_000_000)
    yield Specimen("png of 40,000 x 40,000", _png(40_000, 40_000, _chunk(b"IDAT", many)), "image")
    yield Specimen("png of 2^31 x 1", _png(0x7FFFFFFF, 1, _chunk(b"IDAT", many[:1000])), "image")
    yield Specimen("png of 0 x 0", _png(0, 0, _chunk(b"IDAT", zlib.compress(b"\0"))), "image")
    yield Specimen("png with more data than pixels", _png(40, 30, _chunk(b"IDAT", many)), "image")
    yield Specimen("png within the limit", _png(6000, 6000, _chunk(b"IDAT", many)), "image")
    yield Specimen("interlaced png", _png(6000, 6000, _chunk(b"IDAT", many), interlace=1), "image")
    whole = _chunk(b"IDAT", zlib.compress(bytes(30 * (1 + 40 * 3))))
    text = b"Comment\0\0" + many
    for name, body in ((b"zTXt", text), (b"iTXt", b"Comment\0\1\0\0\0" + many), (b"iCCP", b"profile\0\0" + many)):
        what = f"png with a {name.decode()} of 120 MB"
        yield Specimen(what, _png(40, 30, _chunk(name, body), whole), "image")
    for count in (2000, 30_000):
        yield Specimen(f"png with {count} texts", _png(40, 30, _chunk(b"tEXt", b"a\0b") * count, whole), "image")
    yield Specimen("moving png of 4 billion frames", _png(40, 30, _chunk(b"acTL", b"\xff" * 8), whole), "video")

    frame = b"\x2c" + struct.pack("<HHHHB", 0, 0, 1, 1, 0) + b"\x02\x02\x44\x01\0"
    palette = b"\x80\0\0" + bytes(6)
    for count in (5000, 60_000):
        gif = b"GIF89a" + struct.pack("<HH", 16, 16) + palette + frame * count + b"\x3b"
        yield Specimen(f"gif of {count} frames", gif, "video")
        yield Specimen(f"gif of {count} frames as a picture", gif, "image")
    for role in ("image", "video"):
        huge = b"GIF89a" + struct.pack("<HH", 65535, 65535) + palette + frame * 3 + b"\x3b"
        yield Specimen(f"gif of 65,535 x 65,535 as {role}", huge, role)
    large = b"\x2c" + struct.pack("<HHHHB", 0, 0, 65535, 65535, 0) + b"\x02\x02\x44\x01\0"
    yield Specimen("gif with a frame beyond its canvas",
                   b"GIF89a" + struct.pack("<HH", 16, 16) + palette + large * 3 + b"\x3b", "image")  # fmt: skip

    still = _saved(_picture((16, 16)), "WEBP", lossless=True)[12:]
    for count in (3000, 40_000):
        yield Specimen(f"webp of {count} frames", _webp(16, 16, [still] * count), "video")
    yield Specimen("webp of 2^24 x 2^24", _webp(1 << 24, 1 << 24, [still] * 3), "video")
    yield Specimen("webp whose frames last hours", _webp(16, 16, [still] * 3, 0xFFFFFF), "video")
    yield Specimen("webp without a frame", _webp(16, 16, []), "video")

    jpeg = _saved(_picture(), "JPEG")
    sizes = jpeg.find(b"\xff\xc0") + 5
    for height, width in ((65535, 65535), (0, 48), (40, 0), (6000, 6000)):
        bent = jpeg[:sizes] + struct.pack(">HH", height, width) + jpeg[sizes + 4 :]
        yield Specimen(f"jpeg that claims {width} x {height}", bent, "image")
    comments = b"".join(b"\xff\xfe" + struct.pack(">H", 65535) + bytes(65533) for _ in range(100))
    yield Specimen("jpeg with 6 MB of comments", jpeg[:2] + comments + jpeg[2:], "image")
    for body, what in (
        (b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\xff\xff\0\0\0\0\0\x08", "whose directories go round"),
        (b"MM\0*\0\0\0\x08\xff\xff" + b"\x01\x12\0\x03\xff\xff\xff\xff\0\0\0\0" * 40, "of endless values"),
        (b"II*\0\xff\xff\xff\xff", "that begins at 2^32"),
    ):  # fmt: skip
        exif = b"Exif\0\0" + body
        segment = b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif
        yield Specimen(f"jpeg with EXIF {what}", jpeg[:2] + segment + jpeg[2:], "image")


def _webp(width: int, height: int, stills: list[bytes], milliseconds: int = 50) -> bytes:
    def three(value: int) -> bytes:
        return struct.pack("<I", value & 0xFFFFFF)[:3]

    def chunk(name: bytes, data: bytes) -> bytes:
        return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)

    body = chunk(b"VP8X", b"\x02\0\0\0" + three(width - 1) + three(height - 1)) + chunk(b"ANIM", bytes(6))
    head = bytes(6) + three(15) + three(15) + three(milliseconds) + b"\0"
    body += b"".join(chunk(b"ANMF", head + still) for still in stills)
    return b"RIFF" + struct.pack("<I", len(body) + 4) + b"WEBP" + body


def polyglots(honest: list[Specimen]) -> Iterator[Specimen]:
    """Files that are something else too."""
    page = b"<html><script>fetch('/v1/keys')</script><img src=x onerror=alert(1)></html>"
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("../../../../tmp/escaped", "was here")
    for one in honest:
        yield Specimen(f"{one.what} and a zip", one.content + archive.getvalue(), one.role)
        yield Specimen(f"{one.what} and a page", one.content + page, one.role, "page.html", "text/html")
    jpeg = next(one.content for one in honest if one.what == "jpeg")
    note = b"\xff\xfe" + struct.pack(">H", len(page) + 2) + page
    yield Specimen("jpeg with a page in its comment", jpeg[:2] + note + jpeg[2:], "image", "a.html")
    php = b"Exif\0\0II*\0<?php system($_GET['c']); ?>"
    yield Specimen(
        "jpeg with a program in its EXIF",
        jpeg[:2] + b"\xff\xe1" + struct.pack(">H", len(php) + 2) + php + jpeg[2:], "image", "a.php",
    )  # fmt: skip
    gif = b"GIF89a=1;alert(document.domain)//" + bytes(40)
    yield Specimen("gif that is a script", gif, "image", "a.js", "image/gif")


def impostors() -> Iterator[Specimen]:
    """Texts that programs for video would follow to other files and addresses, plain and behind honest first bytes."""
    lure = "http://127.0.0.1:9/secret"
    texts = {
        "HLS": f"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/passwd\n#EXTINF:1,\n{lure}\n#EXT-X-ENDLIST\n",
        "ffconcat": f"ffconcat version 1.0\nfile /etc/passwd\nfile {lure}\n",
        "SDP": "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 9 RTP/AVP 96\n",
        "DASH": f'<?xml version="1.0"?><MPD><Period><BaseURL>{lure}</BaseURL></Period></MPD>',
        "SVG": f'<svg xmlns="http://www.w3.org/2000/svg"><image href="{lure}"/><image href="file:///etc/passwd"/></svg>',
        "XML bomb": '<!DOCTYPE l [<!ENTITY a "ha">' + "".join(
            f'<!ENTITY {chr(98 + i)} "{"&" + chr(97 + i) + ";" * 1}{("&" + chr(97 + i) + ";") * 9}">' for i in range(9)
        ) + "]><svg>&j;</svg>",
        "XXE": '<!DOCTYPE s [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg><text>&x;</text></svg>',
        "MVG": f"push graphic-context\nimage over 0,0 0,0 '{lure}|touch /tmp/escaped'\npop graphic-context",
        "PostScript": "%!PS\n(/etc/passwd) (r) file\n",
        "ASX": f'<asx version="3.0"><entry><ref href="{lure}"/></entry></asx>',
        "shell": "#!/bin/sh\ntouch /tmp/escaped\n",
        "PDF": "%PDF-1.4\n1 0 obj<</OpenAction<</S/JavaScript/JS(app.alert(1))>>>>endobj",
        "ELF": "\x7fELF\x02\x01\x01",
    }  # fmt: skip
    heads = {
        "mp4": b"\0\0\0\x18ftypisom\0\0\2\0isomiso2",
        "mov": b"\0\0\0\x08wide",
        "mkv": b"\x1a\x45\xdf\xa3\x8f\x42\x82\x88matroska",
        "avi": b"RIFF\xff\xff\xff\xffAVI LIST",
        "gif": b"GIF89a\x10\0\x10\0\0\0\0",
    }
    for what, text in texts.items():
        for role in ("image", "video"):
            yield Specimen(
                f"{what} as {role}", text.encode("latin-1"), role, f"clip.{'jpg' if role == 'image' else 'mp4'}"
            )
        for kind, head in heads.items():
            if what in ("HLS", "ffconcat", "SDP", "DASH"):
                yield Specimen(f"{what} behind {kind}", head + b"\n" + text.encode(), "video", f"clip.{kind}")
    yield Specimen("nothing", b"", "image")
    yield Specimen("one byte", b"\xff", "image")
    yield Specimen("only a head", b"\x89PNG\r\n\x1a\n", "image")
    yield Specimen("zeros", bytes(100_000), "video")


def strange_names(honest: list[Specimen]) -> Iterator[Specimen]:
    png = next(one.content for one in honest if one.what == "png")
    names = [
        "../../../../etc/cron.d/x.png", "..\\..\\windows\\system32\\x.png", "/etc/passwd", "C:\\autoexec.bat",
        "a\0b.png", "\u202egnp.exe", "x" * 10_000 + ".png", "CON", "NUL.png", "aux.jpg", ".", "..", "", " ", "~root",
        "$(touch /tmp/escaped).png", "`id`.png", "a;rm -rf /.png", "-rf", "%2e%2e%2f%2e%2e%2fx.png", "a\r\nX-Evil: 1.png",
        "\ud83d\ude00.png".encode("utf-16", "surrogatepass").decode("utf-16"), "a\u0301\u0327" * 300, "\ufeff.png",
        "<script>alert(1)</script>.png", "'; DROP TABLE files; --.png", "file:///etc/passwd", "\x1b[2J.png",
    ]  # fmt: skip
    for name in names:
        yield Specimen(f"png named {name[:30]!r}", png, "image", name)


def wrong_declarations(honest: list[Specimen]) -> Iterator[Specimen]:
    types = ["image/svg+xml", "text/html", "video/mp4", "image/jpeg", "application/x-mpegURL", "a/b" * 2000, "", "\xff"]
    for one, declared in zip(honest, types * 3, strict=False):
        yield Specimen(f"{one.what} declared as {declared[:20]!r}", one.content, one.role, "a.svg", declared)
    for one in honest:
        other: Role = "video" if one.role == "image" else "image"
        yield Specimen(f"{one.what} in the place of the other", one.content, other, "clip.m3u8")
