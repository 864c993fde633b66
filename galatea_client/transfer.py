"""Files up and down: with progress, and down again from where a broken line left off."""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any, BinaryIO

import httpx

from galatea_client.errors import DownloadBroken, Unreachable
from galatea_client.lines import Line
from galatea_client.transport import Transport

TRANSFER_PIECE_BYTES = 1 << 16
RESUME_SECONDS = 0.5

Upload = str | Path | bytes | bytearray | BinaryIO
"""A file of this machine, what it holds, or one that is open for reading bytes."""

OnProgress = Callable[[int, int], None]
"""Called with the bytes that are through, and how many there are."""


async def send_file(
    transport: Transport,
    operation: str,
    source: Upload,
    progress: OnProgress | None,
    fields: dict[str, str] | None = None,
) -> httpx.Response:
    """Send a file as a form, read as it goes; an open one from its beginning, and it stays open."""
    with _opened(source) as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(0)

        def sent() -> None:
            if progress is not None:
                progress(file.tell(), size)

        named = getattr(file, "name", None)
        name = Path(named).name if isinstance(named, str) else "file"
        form: dict[str, Any] = {"files": {"file": (name, file)}, "data": fields or {}}
        form["timeout"] = httpx.Timeout(30.0, read=300.0, write=300.0)
        return await transport.call(operation, sent=sent, **form)


def _opened(source: Upload) -> AbstractContextManager[BinaryIO]:
    if isinstance(source, bytes | bytearray):
        return nullcontext(io.BytesIO(source))
    return Path(source).open("rb") if isinstance(source, str | Path) else nullcontext(source)


async def fetch(
    transport: Transport, operation: str, path: dict[str, str], to: Path, size: int, sha256: str,
    progress: OnProgress | None = None,
) -> Path:  # fmt: skip
    """Fetch what the service stores to the file `to`, which appears whole and with the right checksum, or not at all.

    What an earlier attempt left beside it (`to` with `.part` added) is taken up by a `Range` request.
    """
    part = to.with_name(to.name + ".part")
    failures = 0
    while (have := part.stat().st_size if part.exists() else 0) != size:
        if have > size:
            part.unlink()
            continue
        headers = {"Range": f"bytes={have}-", "If-Range": f'"{sha256}"'} if have else {}
        try:
            async with transport.stream(operation, path=path, headers=headers) as response:
                await _write(transport.line, response, part, have if response.status_code == 206 else 0, size, progress)
        except httpx.TransportError as error:
            now = part.stat().st_size if part.exists() else 0
            failures = 0 if now > have else failures + 1
            if failures > transport.retries:
                raise Unreachable(f"{to.name}: {error or type(error).__name__}") from error
            await transport.line.sleep(RESUME_SECONDS)
            continue
        if part.stat().st_size != size:
            part.unlink()
            raise DownloadBroken(f"{to.name} has another size now than the {size} bytes that were announced")
    if not part.exists():
        part.touch()
    digest = await transport.line.aside(_digest, part)
    if digest != sha256:
        part.unlink()
        raise DownloadBroken(f"{to.name} arrived with the checksum {digest} instead of {sha256}: fetch it again")
    part.replace(to)
    return to


async def _write(
    line: Line, response: httpx.Response, part: Path, start: int, size: int, progress: OnProgress | None
) -> None:
    with part.open("ab") as file:
        file.truncate(start)
        async for piece in line.pieces(response, TRANSFER_PIECE_BYTES):
            await line.aside(file.write, piece)
            if progress is not None:
                progress(file.tell(), size)


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def target_file(to: str | Path, name: str) -> Path:
    """The file to write: in the folder, or the one that was named. Missing folders are made."""
    path = Path(to)
    if path.is_dir() or path.suffix == "":
        path.mkdir(parents=True, exist_ok=True)
        return path / Path(name).name
    path.parent.mkdir(parents=True, exist_ok=True)
    return path
