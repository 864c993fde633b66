"""Uploads as the API shows them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from service.files.schemas import FileOut
from service.tables.files import File
from service.tables.uploads import Upload


class UploadOut(BaseModel):
    """A resumable upload."""

    id: str
    """Once it is finished, the id of the file."""
    status: Literal["receiving", "finished"]
    name: str
    offset: int
    """As many bytes are safely kept."""
    length: int | None
    """How long it will be; null as long as the client has not said."""
    created_at: datetime
    expires_at: datetime | None
    """When it is erased unless more of it comes; null once it is finished."""
    file: FileOut | None
    """What it became, once it is finished."""

    @classmethod
    def of(cls, upload: Upload, file: File | None = None) -> UploadOut:
        return cls(
            id=upload.id,
            status="finished" if file is not None else "receiving",
            name=upload.name,
            offset=upload.received,
            length=upload.length,
            created_at=upload.created_at,
            expires_at=None if file is not None else upload.expires_at,
            file=FileOut.of(file) if file is not None else None,
        )
