"""A file that is received: it goes straight to disk, and what cannot be accepted is refused early.

Its size is counted and its first bytes are looked at while it streams in, so that a huge or wrong file costs no more
than its beginning. Nothing is decoded here.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from service.files.admission import SNIFFED_BYTES, largest_mb, recognise, too_large
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE, Settings


@dataclass
class Received:
    """A file part, on disk under a name of ours."""

    part: str
    name: str
    declared: str
    path: Path
    size: int = 0
    content_type: str = ""
    sha256: str = ""
    _head: bytes = b""
    _file: BinaryIO | None = None
    _hash: hashlib._Hash = field(default_factory=hashlib.sha256)

    def write(self, data: bytes, settings: Settings) -> None:
        self.size += len(data)
        self._hash.update(data)
        if not self.content_type:
            self._head += data
            if len(self._head) < SNIFFED_BYTES:
                return
            data = self._recognise()
        limit = largest_mb(settings, self.content_type)
        if self.size > limit * BYTES_PER_MEGABYTE:
            raise too_large(f"“{self.name}”", limit)
        if self._file is None:
            self._file = self.path.open("wb")
        self._file.write(data)

    def finish(self, settings: Settings) -> None:
        if self.size == 0:
            raise Problem(422, "file_empty", f"“{self.name}” is empty: it has 0 bytes.")
        if not self.content_type:
            head = self._recognise()
            self.path.write_bytes(head)
        if self._file is not None:
            self._file.close()
            self._file = None
        self.sha256 = self._hash.hexdigest()

    def discard(self) -> None:
        if self._file is not None:
            self._file.close()
        self.path.unlink(missing_ok=True)

    def _recognise(self) -> bytes:
        self.content_type = recognise(self._head, self.name, self.declared)
        head, self._head = self._head, b""
        return head
