"""The parts of a multipart body (RFC 7578) as they come, told one by one. What a part's head may hold is bounded; what
comes after the last part is nobody's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from python_multipart.exceptions import FormParserError
from python_multipart.multipart import MAX_BOUNDARY_LENGTH, MultipartParser, parse_options_header

from service.problems import Problem

MAX_HEADERS = 8
MAX_PART_HEAD_BYTES = 4000
"""The most bytes of all headers of a part."""
CONTENT_TYPE_CHARACTERS = 1000
"""The longest `Content-Type` of a request: to read it takes time by the square of its length."""


@dataclass(frozen=True)
class Head:
    """What a part says of itself."""

    name: str
    filename: str | None
    """None where it names no file; empty where it is a form's field for a file of which none was chosen."""
    declared: str
    """Its media type in small letters, without parameters; empty where it says none."""


class Receiver(Protocol):
    """Who is told of the parts, in their order. All of it takes note only: it is called while a chunk is read."""

    def begin(self, head: Head) -> None: ...
    def data(self, data: bytes) -> None: ...
    def end(self) -> None: ...


class Parts:
    """Reads a multipart body, chunk by chunk."""

    def __init__(self, content_type: str, receiver: Receiver):
        """`content_type` is the request's header. Raises a 422 problem."""
        self.ended = False
        """Whether the last part has come."""
        self._receiver = receiver
        self._headers: dict[bytes, bytes] = {}
        self._name, self._value = bytearray(), bytearray()
        self._head_bytes = 0
        names = ("part_begin", "part_data", "part_end", "header_field", "header_value", "header_end")
        callbacks = {f"on_{n}": getattr(self, f"_on_{n}") for n in (*names, "headers_finished", "end")}
        # Its own limits lie beyond ours, which are told of by codes of their own.
        self._parser = MultipartParser(
            _boundary(content_type),
            callbacks,  # type: ignore[arg-type]
            max_header_count=10 * MAX_HEADERS,
            max_header_size=10**9,
        )

    def write(self, chunk: bytes) -> None:
        """Read one more chunk. Raises a 413 or 422 problem."""
        try:
            self._parser.write(chunk)
        except FormParserError as error:
            raise _invalid(f"cannot be read: {error}") from error

    def _count(self, size: int) -> None:
        self._head_bytes += size
        if self._head_bytes > MAX_PART_HEAD_BYTES or len(self._headers) > MAX_HEADERS:
            detail = f"The headers of a part may be {MAX_HEADERS}, with {MAX_PART_HEAD_BYTES} bytes together, at most."
            raise Problem(413, "part_head_too_large", detail)

    # The parser's callbacks.

    def _on_part_begin(self) -> None:
        self._headers, self._head_bytes = {}, 0

    def _on_header_field(self, data: bytes, start: int, end: int) -> None:
        self._count(end - start)
        self._name += data[start:end]

    def _on_header_value(self, data: bytes, start: int, end: int) -> None:
        self._count(end - start)
        self._value += data[start:end]

    def _on_header_end(self) -> None:
        self._headers[bytes(self._name).lower()] = bytes(self._value)
        self._count(0)
        self._name, self._value = bytearray(), bytearray()

    def _on_headers_finished(self) -> None:
        _, options = parse_options_header(self._headers.get(b"content-disposition", b""))
        if b"name" not in options:
            raise _invalid("has a part without a name")
        name = options[b"name"].decode(errors="replace")
        filename = options[b"filename"].decode(errors="replace") if b"filename" in options else None
        declared = self._headers.get(b"content-type", b"").decode(errors="replace").split(";")[0].strip().lower()
        self._receiver.begin(Head(name, filename, declared))

    def _on_part_data(self, data: bytes, start: int, end: int) -> None:
        self._receiver.data(data[start:end])

    def _on_part_end(self) -> None:
        self._receiver.end()

    def _on_end(self) -> None:
        self.ended = True


def _boundary(content_type: str) -> bytes:
    if len(content_type) > CONTENT_TYPE_CHARACTERS:
        raise _invalid(f"has a Content-Type of more than {CONTENT_TYPE_CHARACTERS} characters")
    boundary = parse_options_header(content_type)[1].get(b"boundary")
    if not boundary:
        raise _invalid("names no boundary")
    if len(boundary) > MAX_BOUNDARY_LENGTH:
        raise _invalid(f"has a boundary of more than {MAX_BOUNDARY_LENGTH} bytes")
    return boundary


def _invalid(why: str) -> Problem:
    return Problem(422, "invalid_multipart", f"The multipart body {why}.")
