"""Receiving multipart bodies: file parts go straight to disk, and what cannot be accepted is refused early.

Sizes are counted and first bytes are looked at while the body streams in, so that a huge or wrong file costs
no more than its beginning. Nothing is decoded here.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

import anyio.to_thread
from fastapi import Request
from python_multipart.exceptions import MultipartParseError
from python_multipart.multipart import MultipartParser, parse_options_header

from service.disk import require_space
from service.files.door import HEAD_BYTES, largest_mb, recognise, shown_name, too_large
from service.ids import new_id
from service.problems import Problem
from service.settings import MEGABYTE, Settings

FIELD_BYTES = 1_000_000
"""The most bytes of parts that are not files, taken together; also of a JSON body."""


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
            if len(self._head) < HEAD_BYTES:
                return
            data = self._recognise()
        limit = largest_mb(settings, self.content_type)
        if self.size > limit * MEGABYTE:
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


class Form:
    """A multipart body that has been received: `async with Form(...) as form`. Leaving it erases what was not kept."""

    def __init__(self, request: Request, settings: Settings, most_files: int):
        self.fields: dict[str, str] = {}
        self.files: list[Received] = []
        self._request = request
        self._settings = settings
        self._most_files = most_files
        self._folder = settings.data_dir / "incoming"
        self._pending: list[tuple[Received | str, bytes | None]] = []
        self._header = (b"", b"")
        self._headers: dict[bytes, bytes] = {}
        self._part: Received | str = ""
        self._field_bytes: dict[str, bytes] = {}

    async def __aenter__(self) -> Form:
        _, parameters = parse_options_header(self._request.headers.get("content-type"))
        boundary = parameters.get(b"boundary")
        if not boundary:
            raise Problem(422, "invalid_multipart", "The multipart body names no boundary.")
        length = self._request.headers.get("content-length", "")
        most = self._settings.video_mb * self._most_files + 2
        if length.isdigit() and int(length) > most * MEGABYTE:
            raise too_large("The request", most)
        require_space(self._settings, int(length) if length.isdigit() else 0)
        self._folder.mkdir(exist_ok=True)
        names = ("part_begin", "part_data", "part_end", "header_field", "header_value", "header_end")
        callbacks = {f"on_{n}": getattr(self, f"_on_{n}") for n in (*names, "headers_finished", "end")}
        try:
            await self._receive(MultipartParser(boundary, callbacks))  # type: ignore[arg-type]
        except BaseException:
            self._discard()
            raise
        return self

    def require_only(self, fields: Sequence[str], files: Sequence[str]) -> None:
        """Raise a 422 problem for a part that the endpoint does not know."""
        for name in (*(set(self.fields) - set(fields)), *({file.part for file in self.files} - set(files))):
            known = " and ".join(f"“{one}”" for one in (*fields, *files))
            raise Problem(422, "unknown_part", f"The part “{name[:80]}” is not known here: send {known}.")

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._discard()

    async def _receive(self, parser: MultipartParser) -> None:
        self._ended = False
        unchecked = 0
        try:
            async for chunk in self._request.stream():
                parser.write(chunk)
                unchecked += len(chunk)
                if unchecked > 16 * MEGABYTE:
                    require_space(self._settings)
                    unchecked = 0
                if self._pending:
                    await anyio.to_thread.run_sync(self._store, self._pending)
                    self._pending = []
            parser.finalize()
        except MultipartParseError as error:
            raise Problem(422, "invalid_multipart", f"The multipart body cannot be read: {error}") from error
        if not self._ended:
            raise Problem(422, "invalid_multipart", "The multipart body ends too early: send it again.")
        for name, data in self._field_bytes.items():
            try:
                self.fields[name] = data.decode()
            except UnicodeDecodeError:
                raise Problem(422, "invalid_multipart", f"The part “{name}” is not UTF-8 text.") from None

    def _store(self, pending: Sequence[tuple[Received | str, bytes | None]]) -> None:
        for part, data in pending:
            if isinstance(part, Received):
                part.finish(self._settings) if data is None else part.write(data, self._settings)

    def _discard(self) -> None:
        for file in self.files:
            with suppress(OSError):
                file.discard()

    # The parser's callbacks. They only take note; `_store` writes, in a thread.

    def _on_part_begin(self) -> None:
        self._headers = {}

    def _on_header_field(self, data: bytes, start: int, end: int) -> None:
        self._header = (self._header[0] + data[start:end], self._header[1])

    def _on_header_value(self, data: bytes, start: int, end: int) -> None:
        self._header = (self._header[0], self._header[1] + data[start:end])

    def _on_header_end(self) -> None:
        self._headers[self._header[0].lower()] = self._header[1]
        self._header = (b"", b"")

    def _on_headers_finished(self) -> None:
        _, options = parse_options_header(self._headers.get(b"content-disposition", b""))
        if b"name" not in options:
            raise Problem(422, "invalid_multipart", "A part of the multipart body has no name.")
        field_name = options[b"name"].decode(errors="replace")
        if b"filename" not in options:
            if field_name in self._field_bytes:
                raise Problem(422, "invalid_multipart", f"The part “{field_name}” is there twice.")
            self._field_bytes[field_name] = b""
            self._part = field_name
            return
        if len(self.files) >= self._most_files:
            raise Problem(413, "too_many_files", f"At most {self._most_files} files are accepted in one request.")
        declared = self._headers.get(b"content-type", b"").decode(errors="replace").split(";")[0].strip().lower()
        name = shown_name(options[b"filename"].decode(errors="replace"))
        self._part = Received(field_name, name, declared, self._folder / new_id())
        self.files.append(self._part)

    def _on_part_data(self, data: bytes, start: int, end: int) -> None:
        if isinstance(self._part, Received):
            self._pending.append((self._part, data[start:end]))
            return
        if sum(map(len, self._field_bytes.values())) + end - start > FIELD_BYTES:
            raise Problem(413, "request_too_large", "The parts that are not files are too large together.")
        self._field_bytes[self._part] += data[start:end]

    def _on_part_end(self) -> None:
        if isinstance(self._part, Received):
            self._pending.append((self._part, None))

    def _on_end(self) -> None:
        self._ended = True
