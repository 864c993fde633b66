"""Receiving forms: files go straight to disk, texts are kept, and what cannot be accepted is refused while it comes.

Whether a part is a file or a text, its name says. A name may stand for either: a job's input is a file, or the id,
address or name of one. Then the part itself says it. What browsers send of a field that was left empty is as if it had
not been sent.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from types import TracebackType

from anyio.lowlevel import checkpoint
from anyio.to_thread import run_sync
from fastapi import Request

from service.disk import require_space
from service.files.admission import shown_name, too_large
from service.files.parts import Head, Parts
from service.files.received import Received
from service.http.bodies import FIELD_BYTES, announced_bytes
from service.http.documents import require_text
from service.ids import new_id
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE, Settings

MAX_FIELDS = 100
"""The most parts that are not files."""
VALUE_BYTES = 4000
"""The longest text that stands for a file: an address."""
INTAKE_SLICE_BYTES = 1 << 16
"""How much is read in one go: others have their turn in between."""
FILE_WRITE_BYTES = 1 << 18
"""How much of files is held in memory before it is written."""

FILE_FAMILIES = ("image", "video", "audio", "model")


class Form:
    """A multipart body that has been received: `async with Form(...) as form`. Leaving it erases what was not kept."""

    def __init__(
        self,
        request: Request,
        settings: Settings,
        most_files: int,
        texts: Sequence[str] = (),
        files: Sequence[str] | None = None,
    ):
        """Parts named as in `texts` are texts, and those named as in `files` are files. Where `files` is None, all
        others are files or texts, as they themselves say; otherwise there may be no others."""
        self.fields: dict[str, str] = {}
        """The texts that are not empty."""
        self.files: list[Received] = []
        self._request = request
        self._settings = settings
        self._most_files = most_files
        self._text_names, self._file_names = texts, files
        self._folder = settings.data_dir / "incoming"
        self._pending: list[tuple[Received, bytes | None]] = []
        self._texts: dict[str, bytearray] = {}
        self._fields = self._field_bytes = 0
        self._head = Head("", None, "")
        self._file: Received | None = None
        """What the part under way has turned out to be; None as long as it may be a text."""
        self._held = bytearray()

    async def __aenter__(self) -> Form:
        parts = Parts(self._request.headers.get("content-type", ""), self)
        length = announced_bytes(self._request)
        most = self._settings.video_mb * self._most_files + 2
        if length > most * BYTES_PER_MEGABYTE:
            raise too_large("The request", most)
        require_space(self._settings, length)
        self._folder.mkdir(exist_ok=True)
        try:
            await self._receive(parts)
        except BaseException:
            self._discard()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._discard()

    async def _receive(self, parts: Parts) -> None:
        unchecked = waiting = 0
        async for chunk in self._request.stream():
            for start in range(0, len(chunk), INTAKE_SLICE_BYTES):
                parts.write(chunk[start : start + INTAKE_SLICE_BYTES])
                await checkpoint()
            unchecked += len(chunk)
            if unchecked > 16 * BYTES_PER_MEGABYTE:
                require_space(self._settings)
                unchecked = 0
            waiting += len(chunk)
            if self._pending and (waiting > FILE_WRITE_BYTES or parts.ended):
                await run_sync(self._store, self._pending)
                self._pending, waiting = [], 0
            if parts.ended:
                break
        if not parts.ended:
            raise Problem(422, "invalid_multipart", "The multipart body ends too early: send it again.")
        for name, data in self._texts.items():
            try:
                self.fields[name] = data.decode()
            except UnicodeDecodeError:
                raise Problem(422, "invalid_multipart", f"The part “{name[:80]}” is not UTF-8 text.") from None
        require_text(self.fields.values(), "A part of the form")

    def _store(self, pending: Sequence[tuple[Received, bytes | None]]) -> None:
        for file, data in pending:
            file.finish(self._settings) if data is None else file.write(data, self._settings)

    def _discard(self) -> None:
        for file in self.files:
            with suppress(OSError):
                file.discard()

    # What `Parts` tells of. It only takes note; `_store` writes, in a thread.

    def begin(self, head: Head) -> None:
        if self._file_names is not None and head.name not in (*self._text_names, *self._file_names):
            known = " and ".join(f"“{one}”" for one in (*self._text_names, *self._file_names))
            raise Problem(422, "unknown_part", f"The part “{head.name[:80]}” is not known here: send {known}.")
        self._head, self._file, self._held = head, None, bytearray()
        if self._says_file() and head.filename:
            self._become_file()
            return
        self._fields += 1
        if self._fields > MAX_FIELDS:
            raise Problem(413, "too_many_parts", f"A form may have {MAX_FIELDS} parts that are not files at most.")

    def data(self, data: bytes) -> None:
        if self._file is None:
            self._held += data
            self._field_bytes += len(data)
            if self._says_file() or (self._may_be_file() and len(self._held) > VALUE_BYTES):
                self._become_file()
            elif self._field_bytes > FIELD_BYTES:
                raise Problem(413, "request_too_large", "The parts that are not files are too large together.")
            return
        self._pending.append((self._file, data))

    def end(self) -> None:
        if self._file is None and self._held and self._may_be_file() and not _is_value(self._held):
            self._become_file()
        if self._file is not None:
            self._pending.append((self._file, None))
        elif self._held:
            if self._head.name in self._texts:
                raise Problem(422, "invalid_multipart", f"The part “{self._head.name[:80]}” is there twice.")
            self._texts[self._head.name] = self._held

    def _may_be_file(self) -> bool:
        return self._head.name not in self._text_names

    def _says_file(self) -> bool:
        """Whether the part's head says that it is a file."""
        if not self._may_be_file():
            return False
        family = self._head.declared.split("/")[0]
        of_a_file = family in FILE_FAMILIES or self._head.declared == "application/octet-stream"
        return self._file_names is not None or bool(self._head.filename) or of_a_file

    def _become_file(self) -> None:
        if len(self.files) >= self._most_files:
            raise Problem(413, "too_many_files", f"At most {self._most_files} files are accepted in one request.")
        self._field_bytes -= len(self._held)
        name = shown_name(self._head.filename or "")
        self._file = Received(self._head.name, name, self._head.declared, self._folder / new_id())
        self.files.append(self._file)
        if self._held:
            self._pending.append((self._file, bytes(self._held)))


def _is_value(held: bytearray) -> bool:
    """Whether a part's content is one line of text, as an id, an address or a name is, and not a small file."""
    try:
        text = held.decode()
    except UnicodeDecodeError:
        return False
    return text.isprintable() and not text.startswith("{")
