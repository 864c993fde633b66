"""Files as the API shows them."""

from __future__ import annotations

from datetime import datetime

from pydantic import BaseModel

from service.tables.files import File


class FileOut(BaseModel):
    """An uploaded file."""

    id: str
    name: str
    content_type: str
    size: int
    sha256: str
    created_at: datetime

    @classmethod
    def of(cls, file: File) -> FileOut:
        return cls.model_validate(file, from_attributes=True)
