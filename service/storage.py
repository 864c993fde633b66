"""Where files and artifacts lie, by key. Keys are made by us; no name that a user gave is ever part of one."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterable, Iterator
from datetime import datetime
from pathlib import Path
from typing import BinaryIO

import obstore
from obstore.store import LocalStore

CHUNK = 1 << 20


class Storage:
    """Files by key in a local folder. What is put appears whole or not at all."""

    def __init__(self, folder: Path):
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._store = LocalStore(folder)

    def put(self, key: str, file: BinaryIO) -> None:
        """Store a whole file under `key`. Raises OSError when the disk is full."""
        try:
            obstore.put(self._store, key, file)
        except OSError:
            raise
        except Exception as error:
            if "No space left" in str(error) or "os error 28" in str(error):
                raise OSError(28, "No space left on device") from error
            raise

    def local(self, key: str) -> Path:
        """The file under `key` as a local path, for work that needs one."""
        return self._folder / key

    async def read(self, key: str, start: int, end: int) -> AsyncIterator[bytes]:
        """The bytes from `start` up to `end` (not included), in pieces. Raises FileNotFoundError."""
        if start >= end:
            return
        found = await obstore.get_async(self._store, key, options={"range": (start, end)})
        async for piece in found.stream(min_chunk_size=CHUNK):
            yield bytes(piece)

    def delete(self, keys: Iterable[str]) -> None:
        """Erase what is stored under `keys`; what is not there is no error."""
        for key in keys:
            try:
                obstore.delete(self._store, key)
            except FileNotFoundError:
                continue

    def keys(self, prefix: str, before: datetime) -> Iterator[str]:
        """The keys under a prefix that were written before a moment."""
        for page in obstore.list(self._store, prefix=prefix):
            yield from (entry["path"] for entry in page if entry["last_modified"] < before)
