"""What a file is by its first bytes, never by its name. Nothing is decoded, so it is safe at the door."""

from __future__ import annotations

import re
from pathlib import Path

_HEAD_BYTES = 4096

# Brands of ISO base media files (the four letters after `ftyp`) that are pictures; other brands are movies.
_HEIF_BRANDS = {b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1", b"mif2"}
_AVIF_BRANDS = {b"avif", b"avis"}
_AUDIO_BRANDS = {b"M4A ", b"M4B ", b"M4P "}

# JSON that begins with one of the members that glTF's outermost object has, in whichever order they come.
_GLTF = re.compile(
    rb'\{\s*"(accessors|animations|asset|buffers|bufferViews|cameras|extensions|extensionsRequired|extensionsUsed|extras|images'
    rb'|materials|meshes|nodes|samplers|scene|scenes|skins|textures)"\s*:'
)

IMAGE_TYPES = frozenset({"image/jpeg", "image/png", "image/webp", "image/heic", "image/avif", "image/gif"})
"""The media types that `engine.media.image.read_image` takes."""

VIDEO_TYPES = frozenset(
    {"video/mp4", "video/quicktime", "video/webm", "video/x-matroska", "video/x-msvideo"}
    | {"image/gif", "image/webp", "image/apng"}
)
"""The media types that `engine.media.video.read_video` takes."""

MOTION_TYPES = frozenset({"text/x-bvh", "model/gltf-binary", "model/gltf+json"})
"""The media types that `engine.motion` reads motions from."""

ARCHIVE_TYPES = frozenset(
    {"application/zip", "application/x-tar", "application/gzip", "application/x-bzip2", "application/x-xz"}
)
"""The media types that `engine.media.archive` unpacks; what NumPy keeps arrays in (`.npz`) is a ZIP, too."""

_ARCHIVES = {
    b"PK\x03\x04": "application/zip",
    b"\x1f\x8b": "application/gzip",
    b"BZh": "application/x-bzip2",
    b"\xfd7zXZ\x00": "application/x-xz",
}
TAR_MAGIC, TAR_MAGIC_OFFSET = b"ustar", 257


def sniff(path: Path) -> str | None:
    """The media type of a file (`image/jpeg`, `video/mp4`, ...) by its magic bytes; None where it is none we know.

    Sound files are named too (`audio/...`), so that an error can say what was sent. A PNG that announces an
    animation is `image/apng`. A known type says nothing of whether the rest of the file is whole.
    """
    with path.open("rb") as file:
        return sniff_bytes(file.read(_HEAD_BYTES))


def is_still_webp(path: Path) -> bool:
    """Whether a file is a WebP without animation (whose flag is in the extended header, VP8X)."""
    with path.open("rb") as file:
        head = file.read(21)
    return head[8:12] == b"WEBP" and not (head[12:16] == b"VP8X" and head[20:21] and head[20] & 2)


def sniff_bytes(head: bytes) -> str | None:
    """The media type of a file that begins with `head` (up to 4096 bytes are looked at)."""
    if head.startswith(b"\xff\xd8\xff"):
        return "image/jpeg"
    if head.startswith(b"\x89PNG\r\n\x1a\n"):
        # The animation's control chunk must come before the first image data.
        return "image/apng" if b"acTL" in head.split(b"IDAT")[0] else "image/png"
    if head[:6] in (b"GIF87a", b"GIF89a"):
        return "image/gif"
    if head[:4] == b"glTF":
        return "model/gltf-binary"
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    if text[:9].upper() == b"HIERARCHY":
        return "text/x-bvh"
    if _GLTF.match(text):
        return "model/gltf+json"
    if head[:4] == b"RIFF":
        return {b"WEBP": "image/webp", b"AVI ": "video/x-msvideo", b"WAVE": "audio/wav"}.get(head[8:12])
    if head.startswith(b"\x1a\x45\xdf\xa3"):
        kind = head.find(b"\x42\x82")  # the element DocType
        return "video/webm" if head[kind + 3 : kind + 7] == b"webm" else "video/x-matroska"
    if head[4:8] in (b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip", b"pnot"):
        return _sniff_iso_media(head)
    return _sniff_archive(head) or _sniff_sound(head)


def _sniff_iso_media(head: bytes) -> str:
    if head[4:8] != b"ftyp":
        return "video/quicktime"  # the oldest movies begin with their data or their index
    size = int.from_bytes(head[:4], "big")
    brands = [head[8:12]] + [head[i : i + 4] for i in range(16, min(size, len(head)), 4)]
    if brands[0] in _AVIF_BRANDS or (brands[0] in _HEIF_BRANDS and _AVIF_BRANDS & set(brands)):
        return "image/avif"
    if brands[0] in _HEIF_BRANDS:
        return "image/heic"
    if brands[0] in _AUDIO_BRANDS:
        return "audio/mp4"
    return "video/quicktime" if brands[0] == b"qt  " else "video/mp4"


def _sniff_archive(head: bytes) -> str | None:
    if head[TAR_MAGIC_OFFSET:].startswith(TAR_MAGIC):
        return "application/x-tar"
    return next((name for magic, name in _ARCHIVES.items() if head.startswith(magic)), None)


def _sniff_sound(head: bytes) -> str | None:
    if head.startswith((b"ID3", b"\xff\xfb", b"\xff\xf3", b"\xff\xf2")):
        return "audio/mpeg"
    if head.startswith(b"OggS"):
        return "audio/ogg"
    return "audio/flac" if head.startswith(b"fLaC") else None
