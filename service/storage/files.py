"""Where files and artifacts lie, by key. Keys are made by us; no name that a user gave is ever part of one."""

from __future__ import annotations

import os
from collections.abc import AsyncIterator, Iterable, Iterator
from contextlib import contextmanager
from datetime import datetime
from errno import EIO, EMLINK, ENOSPC, ENOTSUP, EPERM, EXDEV
from pathlib import Path
from typing import BinaryIO

import obstore
import structlog
from obstore.exceptions import BaseError
from obstore.store import LocalStore, ObjectStore

STREAMED_CHUNK_BYTES = 1 << 20
PART_BYTES = 8 << 20
"""Bytes of one part where a large file is put part by part; few are on their way at once, so that memory stays small."""

PARTS_AT_ONCE = 3


class StorageUnavailable(OSError):
    """The storage cannot be reached, or refuses: the same may work later."""


class Storage:
    """Files by key in a local folder. What is put appears whole or not at all."""

    folder: Path | None
    """The folder that holds the files themselves; None where they lie elsewhere."""

    def __init__(self, folder: Path):
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._store: ObjectStore = LocalStore(folder)

    def put(self, key: str, file: BinaryIO) -> None:
        """Store a whole file under `key`. Raises OSError: when the disk is full, or `StorageUnavailable`."""
        with translate_errors():
            obstore.put(self._store, key, file, chunk_size=PART_BYTES, max_concurrency=PARTS_AT_ONCE)

    def adopt(self, key: str, path: Path) -> None:
        """Store the finished file at `path` under `key`, by a second name for it where both lie on one disk: nothing is
        copied. The first name stays its owner's to erase. Raises OSError as `put` does."""
        if self.folder is None:
            with path.open("rb") as file:
                return self.put(key, file)
        target = self.folder / key
        target.parent.mkdir(parents=True, exist_ok=True)
        with path.open("rb+") as file:
            os.fsync(file.fileno())
        os.utime(path)  # what lies here without a record is erased by its age, and this one's record comes now
        try:
            target.unlink(missing_ok=True)
            target.hardlink_to(path)
        except OSError as error:
            if error.errno not in (EXDEV, EPERM, EMLINK, ENOTSUP):
                raise
            with path.open("rb") as file:
                self.put(key, file)
        else:
            _sync_folder(target.parent)

    def local(self, key: str) -> Path:
        """The file under `key` as a local path, where the storage is a folder."""
        assert self.folder is not None
        return self.folder / key

    def fetch(self, key: str, to: Path) -> Path:
        """The file under `key` as a local path: the file itself, or a copy `to`. Raises FileNotFoundError, OSError."""
        if self.folder is not None:
            return self.local(key)
        with translate_errors(), to.open("wb") as file:
            for piece in obstore.get(self._store, key).stream(min_chunk_size=STREAMED_CHUNK_BYTES):
                file.write(piece)
        return to

    async def read(self, key: str, start: int, end: int) -> AsyncIterator[bytes]:
        """The bytes from `start` up to `end` (not included), in pieces. Raises FileNotFoundError, OSError."""
        if start >= end:
            return
        with translate_errors():
            found = await obstore.get_async(self._store, key, options={"range": (start, end)})
            async for piece in found.stream(min_chunk_size=STREAMED_CHUNK_BYTES):
                yield bytes(piece)

    def delete(self, keys: Iterable[str]) -> None:
        """Erase what is stored under `keys`; what is not there is no error.

        What the storage does not let be erased now, housekeeping finds later: it has no record any more.
        """
        for key in keys:
            try:
                with translate_errors():
                    obstore.delete(self._store, key)
            except FileNotFoundError:
                continue
            except StorageUnavailable as error:
                structlog.get_logger().warning("storage_not_erased", key=key, reason=error.strerror)
                return

    def delete_under(self, prefix: str) -> None:
        """Erase all that is stored under a prefix; see `delete`."""
        try:
            self.delete(list(self.keys(prefix)))
        except StorageUnavailable as error:
            structlog.get_logger().warning("storage_not_erased", key=prefix, reason=error.strerror)

    def keys(self, prefix: str, before: datetime | None = None) -> Iterator[str]:
        """The keys under a prefix, those that were written before a moment if one is given."""
        with translate_errors():
            for page in obstore.list(self._store, prefix=prefix):
                yield from (entry["path"] for entry in page if before is None or entry["last_modified"] < before)

    def sizes(self, prefix: str) -> dict[str, int]:
        """The keys under a prefix with the bytes they hold, newest first."""
        with translate_errors():
            entries = [entry for page in obstore.list(self._store, prefix=prefix) for entry in page]
        entries.sort(key=lambda entry: entry["last_modified"], reverse=True)
        return {entry["path"]: entry["size"] for entry in entries}

    def reachable(self) -> bool:
        """Whether it answers."""
        return True


@contextmanager
def translate_errors() -> Iterator[None]:
    """What obstore raises, as OSErrors."""
    try:
        yield
    except OSError:
        raise
    except BaseError as error:
        if "No space left" in str(error) or "os error 28" in str(error):
            raise OSError(ENOSPC, "No space left on device") from error
        raise StorageUnavailable(EIO, str(error).splitlines()[0]) from error


def _sync_folder(folder: Path) -> None:
    """Let a new name in a folder outlive a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
