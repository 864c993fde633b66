"""One piece of an upload on its way to disk.

The record's `received` is the truth. It grows only when the bytes up to there are on disk to stay, and what lies in the
spool beyond it does not count: it is cut off when the next piece comes. A piece without a checksum is recorded every
few seconds while it comes in, so that little has to be sent again after a crash. A piece with one is recorded only as a
whole. The last bytes are recorded together with the finished file, or not at all.
"""

from __future__ import annotations

import time
from typing import Any, BinaryIO

from service.auth.quotas import require_room
from service.clock import now
from service.context import Context
from service.disk import require_space
from service.files.admission import SNIFFED_BYTES, largest_mb, recognise, too_large
from service.files.service import record
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE
from service.tables.files import File
from service.tables.uploads import Upload
from service.uploads import repository, spool
from service.uploads.checksum import Checksum
from service.uploads.digest import RunningDigest

RECORD_BYTES = 32 * BYTES_PER_MEGABYTE
RECORD_SECONDS = 2.0


class Reception:
    """Takes the bytes of one request. All methods but `take` work on disk: call them in a thread."""

    def __init__(
        self, context: Context, upload: Upload, length: int | None, digest: RunningDigest, checksum: Checksum | None
    ):
        self.upload = upload
        self.length = length
        self.file: File | None = None
        """What the upload became, once all of it has come."""
        self._context = context
        self._settings = context.settings
        self._path = spool.path(context.settings, upload.id)
        self._digest = digest
        self._checksum = checksum
        self._spool: BinaryIO | None = None
        self._taken: list[bytes] = []
        self._end = self._written = upload.received
        self._content_type = ""
        self._recorded_at = time.monotonic()

    @property
    def waiting(self) -> int:
        """As many bytes were taken and are not written yet."""
        return self._end - self._written

    @property
    def partial_counts(self) -> bool:
        """Whether a part of the piece is kept when the line breaks."""
        return self._checksum is None

    def open(self) -> None:
        """Begin where the record says. Raises `Problem`."""
        try:
            self._spool = self._path.open("rb+")
        except FileNotFoundError:
            raise spool.upload_gone() from None
        if self._spool.seek(0, 2) < self.upload.received:
            raise spool.upload_gone()
        self._spool.truncate(self.upload.received)
        self._spool.seek(self.upload.received)
        self._digest.rewind(self.upload.received)
        if self.length is not None and self.length != self.upload.received:
            self._record(length=self.length)

    def take(self, data: bytes) -> None:
        """Take bytes, to be written soon. Raises a 413 problem where there are more than there may be."""
        self._end += len(data)
        if self.length is not None and self._end > self.length:
            raise Problem(
                413,
                "length_exceeded",
                f"The upload is {self.length} bytes long, and more was sent: begin again with the right Upload-Length.",
            )
        limit = largest_mb(self._settings)
        if self._end > limit * BYTES_PER_MEGABYTE:
            raise too_large(f"“{self.upload.name}”", limit)
        self._taken.append(data)

    def write(self) -> None:
        """Write what was taken, and record it if it is time. Raises `Problem`, OSError."""
        require_space(self._settings)
        self._write()
        if self._checksum is None:
            self._look()
            due = time.monotonic() - self._recorded_at > RECORD_SECONDS
            if (due or self._written - self.upload.received >= RECORD_BYTES) and self._written != self.length:
                self._record()

    def settle(self) -> None:
        """Record all that was taken; what is complete becomes a file. Raises `Problem`, OSError."""
        self._write()
        if self._checksum is not None:
            self._checksum.require_match()
        self._look()
        if self._written == self.length:
            self._finish()
        elif self._written != self.upload.received:
            self._record()

    def close(self) -> None:
        """Let go of the spool; what was not recorded is cut off."""
        if self._spool is None:
            return
        if self.file is None:
            self._spool.truncate(self.upload.received)
        self._spool.close()
        self._spool = None

    def _write(self) -> None:
        assert self._spool is not None
        data = b"".join(self._taken)
        self._taken.clear()
        self._spool.write(data)
        self._spool.flush()
        self._digest.update(data, self._written)
        if self._checksum is not None:
            self._checksum.update(data)
        self._written += len(data)

    def _look(self) -> None:
        """Find out what is coming as soon as that can be told. What cannot be accepted is erased at once: no byte that
        follows could mend it. Raises `Problem`."""
        if self._content_type or (self._written < SNIFFED_BYTES and self._written != self.length):
            return
        try:
            self._content_type = recognise(
                spool.head(self._path, min(SNIFFED_BYTES, self._written)), self.upload.name, self.upload.declared
            )
            limit = largest_mb(self._settings, self._content_type)
            if max(self._written, self.length or 0) > limit * BYTES_PER_MEGABYTE:
                raise too_large(f"“{self.upload.name}”", limit)
        except Problem:
            spool.erase(self._context, self.upload.id)
            raise

    def _record(self, **values: Any) -> None:
        """Make the bytes written so far count. Raises a 410 problem if the upload is no more."""
        if self._written != self.upload.received:
            spool.sync(self._spool)
        values |= {"received": self._written, "expires_at": spool.expiry(self._settings)}
        with self._context.database.write() as session:
            if not repository.advance(session, self.upload, **values):
                raise spool.upload_gone()
            if self.length is None:
                require_room(session, self._settings, self.upload.owner, 0)
        for name, value in values.items():
            setattr(self.upload, name, value)
        self._recorded_at = time.monotonic()

    def _finish(self) -> None:
        """Make the spool's file one of the service's. Raises `Problem`, OSError."""
        file = File(
            id=self.upload.id,
            owner=self.upload.owner,
            name=self.upload.name,
            content_type=self._content_type,
            size=self._written,
            sha256=self._digest.of(self._path),
            created_at=now(),
        )
        self._context.storage.adopt(file.key, self._path)
        try:
            with self._context.database.write() as session:
                record(session, file)
                values = {"received": file.size, "length": file.size, "file_id": file.id}
                if not repository.advance(session, self.upload, **values):
                    raise spool.upload_gone()
                require_room(session, self._settings, file.owner, 0)
        except BaseException:
            self._context.storage.delete([file.key])
            raise
        self.upload.received = self.upload.length = file.size
        self.upload.file_id = file.id
        self.file = file
        self._path.unlink(missing_ok=True)
