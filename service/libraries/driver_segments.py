"""What a search found in a driver: the segments of it that hold emotions and gestures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from pydantic import BaseModel, Field

from engine.performances import State
from engine.performances.catalogue import Strength
from service.context import Context
from service.libraries import repository
from service.libraries.inspections import Inspection, inspections_of
from service.libraries.library import DRIVER_LIBRARY
from service.problems import Problem
from service.tables.kept import Kept

POSTER_NAME = "poster.jpg"
"""The picture of the face at rest that a search leaves."""

Seconds = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Segment(BaseModel):
    """A segment of a driver, as the search wrote it down."""

    name: Annotated[str, Field(pattern=r"^[a-z]+(-[0-9]+)?$", max_length=40)]
    state: State
    strength: Strength
    start: Seconds
    end: Seconds
    seconds: Seconds
    apex: Seconds
    score: Annotated[float, Field(ge=0, le=1)]


class Segments(BaseModel):
    """All that was found; `seconds`: how long the video is."""

    seconds: Seconds
    segments: Annotated[tuple[Segment, ...], Field(max_length=200, alias="moments")]


def of_drivers(context: Context, drivers: Sequence[Kept]) -> dict[str, Inspection[Segments]]:
    """What was found in each of an owner's drivers, by their names."""
    return inspections_of(context, DRIVER_LIBRARY, Segments, drivers)


def segments(inspection: Inspection[Segments]) -> tuple[Segment, ...]:
    """The segments that a search has found."""
    return inspection.document.segments if inspection.document is not None else ()


def segment(context: Context, owner: str, name: str, segment_name: str) -> tuple[str, Segment]:
    """The file of a driver, and one of its segments. Raises a 422 problem where there is none of this name (yet)."""
    with context.database.read() as session:
        driver = repository.get(session, DRIVER_LIBRARY, owner, name)
    if driver is None:
        raise Problem(422, "unknown_driver", f"There is no driver “{name[:80]}”: GET /v1/drivers lists them.")
    inspection = of_drivers(context, [driver])[name]
    if inspection.status == "pending":
        raise Problem(422, "moments_pending", f"“{name}” is still being searched for moments: wait until it is ready.")
    for one in segments(inspection):
        if one.name == segment_name:
            return driver.file_id, one
    names = ", ".join(one.name for one in segments(inspection)) or "none"
    raise Problem(422, "unknown_moment", f"“{name}” has no moment “{segment_name[:80]}”; it has {names}.")


def missing_segment(name: str, segment_name: str) -> Problem:
    return Problem(404, "moment_not_found", f"“{name}” has no moment “{segment_name[:80]}” (yet).")
