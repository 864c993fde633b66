"""Drivers as the API shows them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from engine.performances import Performance, State
from engine.performances.catalogue import Strength
from service.libraries.driver_segments import Segment, Segments, segments
from service.libraries.inspections import Inspection, InspectionStatus
from service.tables.files import File
from service.tables.kept import Kept


class MomentOut(BaseModel):
    """A moment of a driver that holds a state. A job can name it as its driver: `driver/moment`."""

    name: str
    state: State
    strength: Strength
    start: float
    end: float
    """Seconds from the beginning of the video; the face is at rest at both."""
    seconds: float
    apex: float
    """When the state is at its height, in seconds from the beginning of the video."""
    score: float
    """How sure it is, in [0, 1]."""
    url: str
    """Where the video is, as a media fragment: players show the moment alone."""
    poster: str
    """Where a small picture of it is."""


class DriverOut(BaseModel):
    """A driving video that a job can name."""

    name: str
    source: Literal["built-in", "own"]
    url: str
    """Where the video is."""
    poster: str | None = None
    """Where a small picture of it is; null where there is none."""
    title: str | None = None
    state: State | None = None
    """What it shows: one of the states that a reactive portrait can be in."""
    emotion: str | None = None
    strength: Strength | None = None
    seconds: float | None = None
    loops: bool | None = None
    """Whether the last frame leads into the first."""
    size: int | None = None
    content_type: str | None = None
    created_at: datetime | None = None
    moments: list[MomentOut] = []
    """The moments of one's own driver that hold emotions and gestures, in the order of the states, the best first."""
    moments_status: InspectionStatus = "none"
    """How far the search for them is; `none`: there was no search."""
    moments_job: str | None = None
    """The job that searches: its events tell how far it is, its error why it failed."""

    @classmethod
    def built_in(cls, performance: Performance) -> DriverOut:
        return cls(
            name=performance.name,
            source="built-in",
            url=f"/v1/drivers/{performance.name}/video",
            poster=f"/v1/drivers/{performance.name}/poster",
            title=performance.title,
            state=performance.state,
            emotion=performance.emotion,
            strength=performance.strength,
            seconds=performance.seconds,
            loops=performance.loops,
            content_type="video/mp4",
        )

    @classmethod
    def own(cls, driver: Kept, file: File, inspection: Inspection[Segments]) -> DriverOut:
        return cls(
            name=driver.name,
            source="own",
            url=f"/v1/drivers/{driver.name}/video",
            size=file.size,
            content_type=file.content_type,
            created_at=driver.created_at,
            poster=f"/v1/drivers/{driver.name}/poster" if inspection.status == "ready" else None,
            seconds=inspection.document.seconds if inspection.document is not None else None,
            moments=[_shown(driver, segment) for segment in segments(inspection)],
            moments_status=inspection.status,
            moments_job=driver.inspection_job if inspection.status != "none" else None,
        )


def _shown(driver: Kept, segment: Segment) -> MomentOut:
    address = f"/v1/drivers/{driver.name}"
    return MomentOut(
        **segment.model_dump(),
        url=f"{address}/video#t={segment.start:g},{segment.end:g}",
        poster=f"{address}/moments/{segment.name}/poster",
    )


class DriverList(BaseModel):
    """All drivers: the built-in ones first."""

    items: list[DriverOut]
