"""What clients can do with uploads: begin one, add to it, look at it, end it."""

from __future__ import annotations

import anyio
from anyio.to_thread import run_sync
from fastapi import Request
from starlette.requests import ClientDisconnect

from service.auth.quotas import require_room, require_upload
from service.clock import now
from service.connections.body_timeout import Stalled, Stopped
from service.context import Context
from service.disk import require_space
from service.files.admission import largest_mb, shown_name, too_large
from service.files.service import erase_unused
from service.ids import is_id, new_id
from service.problems import Problem
from service.settings import BYTES_PER_MEGABYTE
from service.tables.files import File
from service.tables.uploads import Upload
from service.uploads import metadata, repository, spool
from service.uploads.reception import Reception
from service.uploads.under_way import UploadHold

UPLOAD_WRITE_BYTES = 1 << 20
"""How much of a piece that comes in is held in memory."""


def create(context: Context, owner: str, length: int | None, notes: str | None) -> Upload:
    """Begin an upload. Raises `Problem`."""
    pairs = metadata.parse(notes or "")
    name = shown_name(pairs.get("filename") or pairs.get("name") or "")
    declared = (pairs.get("filetype") or pairs.get("type") or "").split(";")[0].strip().lower()[:100]
    moment = now()
    upload = Upload(
        id=new_id(),
        owner=owner,
        name=name,
        declared=declared if declared.isascii() and declared.isprintable() else "",
        notes=notes,
        length=length,
        received=0,
        created_at=moment,
        expires_at=spool.expiry(context.settings),
        file_id=None,
    )
    require_length(context, upload, length)
    require_space(context.settings, length or 0)
    spool.create(context.settings, upload.id)
    try:
        with context.database.write() as session:
            require_upload(session, context.settings, owner)
            require_room(session, context.settings, owner, length or 0)
            session.add(upload)
    except BaseException:
        spool.path(context.settings, upload.id).unlink()
        raise
    return upload


def found(context: Context, owner: str, upload_id: str) -> tuple[Upload, File | None]:
    """An upload, and the file that it became. Raises a 404 or 410 problem."""
    with context.database.read() as session:
        upload = repository.get(session, owner, upload_id) if is_id(upload_id) else None
        file = session.get(File, upload.file_id) if upload is not None and upload.file_id else None
    if upload is None:
        raise Problem(404, "upload_not_found", "There is no such upload: it has expired, was ended, or never was.")
    if file is None and upload.expires_at < now():
        raise spool.upload_gone()
    return upload, file


def require_length(context: Context, upload: Upload, length: int | None) -> None:
    """Raise a problem if the upload cannot have this length."""
    if length is None:
        return
    if length == 0:
        raise Problem(422, "file_empty", f"“{upload.name}” is empty: it has 0 bytes.")
    limit = largest_mb(context.settings, upload.declared)
    if length > limit * BYTES_PER_MEGABYTE:
        raise too_large(f"“{upload.name}”", limit)
    if upload.length not in (None, length) or length < upload.received:
        raise Problem(
            422,
            "length_conflict",
            f"The upload cannot be {length} bytes long: "
            + (f"{upload.length} were announced." if upload.length else f"{upload.received} have come already."),
        )


async def receive(request: Request, hold: UploadHold, reception: Reception) -> None:
    """Add the request's body to an upload. What came before the line broke is kept, unless it has a checksum to meet.

    Raises `Problem`; `ClientDisconnect` where nobody is there to be told anything.
    """
    try:
        await run_sync(reception.open)
        broken = await _stream(request, hold, reception)
        if broken is None or reception.partial_counts:
            await run_sync(reception.settle)
        if broken is not None:
            raise broken
    finally:
        with anyio.CancelScope(shield=True):
            await run_sync(reception.close)


async def _stream(request: Request, hold: UploadHold, reception: Reception) -> Exception | None:
    """Take the body as it comes. Returns why it ended early, if it did."""
    try:
        with hold.interruptible as scope:
            await _take(request, reception)
    except ClientDisconnect as disconnect:
        return disconnect
    except Stopped as stopped:
        detail = "The service is stopping: ask where the upload stands when it is back."
        return Problem(503, "service_stopping", detail, headers=stopped.headers)
    except Stalled:
        return Problem(408, "upload_stalled", "Nothing came for too long: ask where the upload stands, and go on.")
    if scope.cancelled_caught:
        return Problem(423, "upload_taken_over", "A later request has taken the upload over: ask where it stands.")
    return None


async def _take(request: Request, reception: Reception) -> None:
    async for data in request.stream():
        reception.take(data)
        if reception.waiting >= UPLOAD_WRITE_BYTES:
            await run_sync(reception.write)


def terminate(context: Context, upload: Upload) -> None:
    """End an upload and erase what came of it; a file that it became stays where a job or a driver uses it."""
    spool.erase(context, upload.id)
    if upload.file_id is not None:
        erase_unused(context, [upload.file_id])
