"""What may come in: pictures, videos, motions and archives, told by their first bytes and never by their names, of a size that their kind
may have. Nothing is decoded here."""

from __future__ import annotations

from engine.media.sniff import ARCHIVE_TYPES, IMAGE_TYPES, MOTION_TYPES, VIDEO_TYPES, sniff_bytes
from service.problems import Problem
from service.settings import Settings

SNIFFED_BYTES = 4096
"""How many first bytes tell what a file is."""


def recognise(head: bytes, name: str, declared: str) -> str:
    """The media type of a file that begins with `head`. Raises a 415 problem if it is none that can be read, or if it
    was declared as something else (`declared` is a media type, or empty)."""
    found = sniff_bytes(head)
    if found is None or found not in IMAGE_TYPES | VIDEO_TYPES | MOTION_TYPES | ARCHIVE_TYPES:
        raise Problem(
            415,
            "media_type_unsupported",
            f"“{name}” is no picture, video, motion or archive that can be read"
            + (f" ({found})" if found else "")
            + ": send JPEG, PNG, WebP, HEIC, AVIF or GIF, MP4, MOV, WebM, MKV or AVI, BVH, GLB or glTF, or ZIP or TAR.",
        )
    family = declared.split("/")[0]
    if family in ("image", "video", "audio", "text") and family != found.split("/")[0] and found != "image/gif":
        raise Problem(
            415,
            "media_type_mismatch",
            f"“{name}” is declared as {declared} but holds {found}: send it under its own type.",
        )
    return found


def largest_mb(settings: Settings, content_type: str = "") -> float:
    """How large a file of a media type may be, in megabytes; the most of all where it is none of ours."""
    if content_type not in IMAGE_TYPES | VIDEO_TYPES:
        return max(settings.image_mb, settings.video_mb)
    return settings.image_mb if content_type in IMAGE_TYPES - VIDEO_TYPES else settings.video_mb


def too_large(what: str, limit_mb: float) -> Problem:
    return Problem(413, "file_too_large", f"{what} is larger than {limit_mb:g} MB, the most that is accepted.")


def shown_name(name: str) -> str:
    """A file's name as it may be shown: the last part of its path, without control characters, at most 255 long.

    It never becomes a path: files lie under ids.
    """
    last = name.replace("\\", "/").rsplit("/", 1)[-1]
    return "".join(c for c in last if c.isprintable()).strip()[:255] or "unnamed"
