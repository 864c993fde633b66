"""All artifacts of a job as one zip, made while it is sent: nothing of it is ever on disk or whole in memory.

Entries are stored, not compressed: videos and pictures are compressed already.
"""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from zipfile import ZIP_STORED, ZipFile, ZipInfo

from service.storage.files import Storage
from service.tables.artifacts import Artifact

ZIP64_FROM = 1 << 31


class _Outlet:
    """A file that cannot seek: what the zip writes waits here until it is sent."""

    def __init__(self) -> None:
        self._waiting = bytearray()

    def write(self, data: bytes) -> int:
        self._waiting += data
        return len(data)

    def flush(self) -> None:
        """Nothing lies elsewhere."""

    def close(self) -> None:
        """Nothing is open."""

    def taken(self) -> bytes:
        data = bytes(self._waiting)
        self._waiting.clear()
        return data


async def zipped(artifacts: Sequence[Artifact], storage: Storage) -> AsyncIterator[bytes]:
    """The bytes of the zip, in pieces."""
    outlet = _Outlet()
    with ZipFile(outlet, "w", ZIP_STORED) as archive:
        for artifact in artifacts:
            entry = ZipInfo(artifact.name, artifact.created_at.timetuple()[:6])
            entry.external_attr = 0o644 << 16
            with archive.open(entry, "w", force_zip64=artifact.size >= ZIP64_FROM) as file:
                async for piece in storage.read(artifact.key, 0, artifact.size):
                    file.write(piece)
                    yield outlet.taken()
    yield outlet.taken()
