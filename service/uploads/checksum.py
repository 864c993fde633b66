"""The checksum of one piece of an upload (the protocol's checksum extension)."""

from __future__ import annotations

import base64
import binascii
import hashlib
import zlib
from collections.abc import Callable, Mapping
from typing import Protocol

from service.problems import Problem


class Sum(Protocol):
    """As hashlib's objects are."""

    def update(self, data: bytes, /) -> None: ...
    def digest(self) -> bytes: ...


class Crc32:
    """CRC-32 (as of zip files), as four bytes, the most significant first."""

    def __init__(self) -> None:
        self._value = 0

    def update(self, data: bytes, /) -> None:
        self._value = zlib.crc32(data, self._value)

    def digest(self) -> bytes:
        return self._value.to_bytes(4, "big")


CHECKSUM_ALGORITHMS: Mapping[str, Callable[[], Sum]] = {
    "sha1": lambda: hashlib.sha1(usedforsecurity=False),
    "sha256": hashlib.sha256,
    "crc32": Crc32,
}


class Checksum:
    """What a piece is said to sum up to, and what it does."""

    def __init__(self, header: str):
        """`header` is `ALGORITHM BASE64`. Raises a 400 problem."""
        name, _, expected = header.strip().partition(" ")
        if name.lower() not in CHECKSUM_ALGORITHMS:
            offered = ", ".join(CHECKSUM_ALGORITHMS)
            raise Problem(400, "checksum_unsupported", f"Upload-Checksum names an unknown algorithm: use {offered}.")
        self._sum = CHECKSUM_ALGORITHMS[name.lower()]()
        try:
            self._expected = base64.b64decode(expected.strip(), validate=True)
        except (binascii.Error, ValueError):
            self._expected = b""
        if len(self._expected) != len(self._sum.digest()):
            raise Problem(400, "checksum_unsupported", f"Upload-Checksum must be `{name} BASE64` of the raw digest.")

    def update(self, data: bytes) -> None:
        self._sum.update(data)

    def require_match(self) -> None:
        """Raise a 460 problem if the piece is not what was sent."""
        if self._sum.digest() != self._expected:
            raise Problem(460, "checksum_mismatch", "The piece was damaged on its way and is not kept: send it again.")
