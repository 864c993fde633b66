"""The mark that a picture or video is synthetic, as machines read it.

XMP with the IPTC's digital source type `compositeSynthetic`: "mix or composite of several elements, at least one of
which is synthetic". The portrait's pixels were captured, their motion was made by a program. The neighbouring terms do
not fit: `trainedAlgorithmicMedia` is for what a model made that was trained on media, and nothing here was;
`algorithmicMedia` is for what mathematics alone made.

The mark lies where each format keeps XMP (XMP Specification part 3). That is a `uuid` box of its own in MP4, an APP1
segment in JPEG, an `iTXt` chunk in PNG, an `XMP ` chunk in WebP, and an application extension in GIF. WebM has tags
alone. No pixel is changed by it.
"""

from __future__ import annotations

import zlib
from pathlib import Path

SOURCE_TYPE = "http://cv.iptc.org/newscodes/digitalsourcetype/compositeSynthetic"
SYNTHETIC_STATEMENT = "Synthetic: made from a still picture by Galatea."
VIDEO_TAGS = {"comment": SYNTHETIC_STATEMENT, "DIGITAL_SOURCE_TYPE": SOURCE_TYPE}
"""Tags of a video file: `SYNTHETIC_STATEMENT` and `SOURCE_TYPE`."""

XMP_PACKET = (
    '<?xpacket begin="\ufeff" id="W5M0MpCehiHzreSzNTczkc9d"?>'
    '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
    '<rdf:Description rdf:about="" xmlns:Iptc4xmpExt="http://iptc.org/std/Iptc4xmpExt/2008-02-29/" '
    'xmlns:xmp="http://ns.adobe.com/xap/1.0/" xmlns:dc="http://purl.org/dc/elements/1.1/">'
    f"<Iptc4xmpExt:DigitalSourceType>{SOURCE_TYPE}</Iptc4xmpExt:DigitalSourceType>"
    "<xmp:CreatorTool>Galatea</xmp:CreatorTool>"
    f'<dc:description><rdf:Alt><rdf:li xml:lang="x-default">{SYNTHETIC_STATEMENT}</rdf:li></rdf:Alt></dc:description>'
    '</rdf:Description></rdf:RDF></x:xmpmeta><?xpacket end="r"?>'
).encode()

XMP_BOX_UUID = bytes.fromhex("BE7ACFCB97A942E89C71999491E3AFAC")
"""Names the box of an MP4 file that holds XMP."""

_JPEG_NAME = b"http://ns.adobe.com/xap/1.0/\0"
_PNG_KEYWORD = b"XML:com.adobe.xmp"
_PNG_SIGNATURE = 8
_IHDR_CHUNK_BYTES = 25


def mark_image(path: Path) -> None:
    """Mark a picture (`.jpg` or `.png`) that has just been written."""
    data = path.read_bytes()
    path.write_bytes(marked_png(data) if path.suffix == ".png" else marked_jpeg(data))


def append_to_gif(path: Path) -> None:
    """Add the mark as an application extension before the end of the file."""
    end = (
        b"\x01" + bytes(range(255, -1, -1)) + b"\0"
    )  # wherever a reader's skipping of blocks lands in it, it comes to the end
    with path.open("r+b") as file:
        file.seek(-1, 2)
        file.write(b"\x21\xff\x0bXMP DataXMP" + XMP_PACKET + end + b"\x3b")


def append_to_mp4(path: Path) -> None:
    """Add the mark as the last box, so that nothing before it moves (`faststart` included)."""
    box = XMP_BOX_UUID + XMP_PACKET
    with path.open("ab") as file:
        file.write((8 + len(box)).to_bytes(4, "big") + b"uuid" + box)


def marked_png(png: bytes) -> bytes:
    """A PNG with the mark behind its header."""
    end = _PNG_SIGNATURE + _IHDR_CHUNK_BYTES
    body = b"iTXt" + _PNG_KEYWORD + bytes(5) + XMP_PACKET
    chunk = (len(body) - 4).to_bytes(4, "big") + body + zlib.crc32(body).to_bytes(4, "big")
    return png[:end] + chunk + png[end:]


def marked_jpeg(jpeg: bytes) -> bytes:
    """A JPEG with the mark behind its first segments (`JFIF`, which has to come first, and `Exif`)."""
    at = 2
    while jpeg[at : at + 2] in (b"\xff\xe0", b"\xff\xe1"):
        at += 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
    body = _JPEG_NAME + XMP_PACKET
    return jpeg[:at] + b"\xff\xe1" + (2 + len(body)).to_bytes(2, "big") + body + jpeg[at:]
