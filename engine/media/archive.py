"""Pictures out of an archive (ZIP, or TAR with or without compression) that a stranger has made.

Nothing of it decides where a file is written, and nothing is believed of what it says of its sizes: bytes are counted as they
come. Names are kept as words for people alone.
"""

from __future__ import annotations

import gzip
import lzma
import tarfile
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO

from engine.errors import InputError
from engine.media.sniff import TAR_MAGIC, TAR_MAGIC_OFFSET

MAX_FILES = 2000
"""Of an archive, whatever they are."""
MAX_UNPACKED_BYTES = 4_000_000_000
"""Of all files of an archive together: two hundred photographs of a phone have a fifth of it."""
MAX_EXPANSION = 100
"""Unpacked bytes for each of the archive's own, beyond the first ten million: photographs are packed already."""
FREE_BYTES = 10_000_000
MAX_NAME = 200
"""Characters of a name that are kept."""

_CHUNK = 1 << 20
_HEADS = (
    b"PK\x03\x04",
    b"PK\x05\x06",
    b"\x1f\x8b",
    b"BZh",
    b"\xfd7zXZ\x00",
    b"7z\xbc\xaf\x27\x1c",
    b"Rar!",
    b"\x28\xb5\x2f\xfd",
)
_BROKEN = (
    *(zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, gzip.BadGzipFile, EOFError),
    *(ValueError, IndexError, NotImplementedError, RuntimeError),
)
"""What readers raise of a damaged archive or of one that they do not know, beside OSError without a number."""


@dataclass(frozen=True)
class UnpackedFile:
    """A file out of an archive: where it is now, and what it was called there."""

    path: Path
    name: str


def is_archive(path: Path) -> bool:
    """Whether a file's first bytes are those of an archive, of a kind that is read here or not."""
    with path.open("rb") as file:
        return _begins_as_archive(file.read(TAR_MAGIC_OFFSET + len(TAR_MAGIC)))


def unpack_pictures(path: Path, folder: Path) -> list[UnpackedFile]:
    """All files of an archive, written into the existing empty `folder` under names of ours, but for what file managers leave.

    Raises
    ------
    InputError : `archive_unsafe` (a name leads outside, or a member is a link or a device), `archive_nested`, `archive_encrypted`,
        `archive_too_large`, `archive_unreadable`. What was written by then stays in the folder.
    """
    files: list[UnpackedFile] = []
    budget = FREE_BYTES + MAX_EXPANSION * path.stat().st_size
    left = min(budget, MAX_UNPACKED_BYTES)
    try:
        for count, (name, stream) in enumerate(_members(path)):
            if count >= MAX_FILES:
                raise _too_large(f"more than {MAX_FILES} files")
            if _left_by_file_managers(name):
                continue
            target = folder / f"{len(files):04}"
            left -= _copied(stream, target, left)
            files.append(UnpackedFile(target, name.name[-MAX_NAME:]))
    except (*_BROKEN, OSError) as error:
        if isinstance(error, OSError) and error.errno is not None:  # the disk's, not the archive's
            raise
        raise InputError(
            "archive_unreadable", "The archive is damaged or of an unknown kind: pack the photos anew, as ZIP."
        ) from error
    return files


def _members(path: Path) -> Iterator[tuple[PurePosixPath, IO[bytes]]]:
    if zipfile.is_zipfile(path):
        with zipfile.ZipFile(path) as archive:
            for info in archive.infolist():
                name = _safe(info.filename)
                if info.flag_bits & 1:
                    raise InputError(
                        "archive_encrypted", "The archive asks for a password: pack the photos without one."
                    )
                if (info.external_attr >> 16) & 0o170000 == 0o120000:
                    raise _unsafe("a link")
                if not info.is_dir():
                    with archive.open(info) as stream:
                        yield name, stream
        return
    with tarfile.open(path) as packed:
        for member in packed:
            name = _safe(member.name)
            if member.isfile():
                content = packed.extractfile(member)
                assert content is not None
                yield name, content
            elif not member.isdir():
                raise _unsafe("a link or a device")


def _safe(name: str) -> PurePosixPath:
    path = PurePosixPath(name.replace("\\", "/"))
    if path.is_absolute() or ".." in path.parts or ":" in (path.parts or ("",))[0] or "\0" in name:
        raise _unsafe("a name that leads outside of it")
    return path


def _left_by_file_managers(name: PurePosixPath) -> bool:
    return "__MACOSX" in name.parts or name.name.startswith(".") or name.name.lower() in ("thumbs.db", "desktop.ini")


def _copied(stream: IO[bytes], target: Path, left: int) -> int:
    """Write a member; how many bytes it has."""
    size = 0
    with target.open("wb") as out:
        while chunk := stream.read(_CHUNK):
            if not size and _begins_as_archive(chunk):
                raise InputError(
                    "archive_nested", "The archive holds another archive: unpack that one first, or send it alone."
                )
            size += len(chunk)
            if size > left:
                raise _too_large("more bytes than photos take")
            out.write(chunk)
    return size


def _begins_as_archive(head: bytes) -> bool:
    return head.startswith(_HEADS) or head[TAR_MAGIC_OFFSET:].startswith(TAR_MAGIC)


def _unsafe(what: str) -> InputError:
    return InputError(
        "archive_unsafe", f"The archive holds {what}, which is refused: pack the photos themselves, nothing else."
    )


def _too_large(what: str) -> InputError:
    return InputError("archive_too_large", f"The archive holds {what}: send fewer photos, or smaller ones.")
