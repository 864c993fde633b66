"""The SHA-256 of an upload, kept up while it comes in, so that a long one is not read again at its end.

The state of a hash can be kept in memory only. Where it was lost (another process, a piece that was taken back), what
it has not seen is read from disk at the end: correct in any case, quick in the usual one.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

DIGESTED_CHUNK_BYTES = 1 << 20


class RunningDigest:
    """The SHA-256 of the first `position` bytes."""

    def __init__(self) -> None:
        self.position = 0
        self._hash = hashlib.sha256()

    def rewind(self, offset: int) -> None:
        """Forget everything if more was seen than the first `offset` bytes."""
        if self.position > offset:
            self.__init__()  # type: ignore[misc]

    def update(self, data: bytes, offset: int) -> None:
        """See the bytes at `offset`, if they are the next ones."""
        if offset == self.position:
            self._hash.update(data)
            self.position += len(data)

    def of(self, path: Path) -> str:
        """The SHA-256 of the whole file, as hexadecimal digits."""
        with path.open("rb") as file:
            file.seek(self.position)
            while data := file.read(DIGESTED_CHUNK_BYTES):
                self.update(data, self.position)
        return self._hash.hexdigest()
