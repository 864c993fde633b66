"""Drivers as the API shows them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from engine.performances import Performance
from service.drivers.models import Driver
from service.files.models import File


class DriverOut(BaseModel):
    """A driving video that a job can name."""

    name: str
    source: Literal["built-in", "own"]
    url: str
    """Where the video is."""
    title: str | None = None
    seconds: float | None = None
    loops: bool | None = None
    """Whether the last frame leads into the first."""
    size: int | None = None
    content_type: str | None = None
    created_at: datetime | None = None

    @classmethod
    def built_in(cls, performance: Performance) -> DriverOut:
        return cls(
            name=performance.name,
            source="built-in",
            url=f"/v1/drivers/{performance.name}/video",
            title=performance.title,
            seconds=performance.seconds,
            loops=performance.loops,
            content_type="video/mp4",
        )

    @classmethod
    def own(cls, driver: Driver, file: File) -> DriverOut:
        return cls(
            name=driver.name,
            source="own",
            url=f"/v1/drivers/{driver.name}/video",
            size=file.size,
            content_type=file.content_type,
            created_at=driver.created_at,
        )


class DriverList(BaseModel):
    """All drivers: the built-in ones first."""

    items: list[DriverOut]
