"""What clients can see of drivers; keeping and erasing them is as with all that is kept (`service.keeping`)."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from engine.stage_keys import content_hash
from service.catalogue import built_in
from service.context import Context
from service.drivers.schemas import DriverOut
from service.job_records import artifacts
from service.keeping.presentation import Presentation
from service.keeping.service import file_of, not_found_problem
from service.libraries import repository
from service.libraries.driver_segments import POSTER_NAME, Segments, missing_segment, of_drivers, segments
from service.libraries.library import DRIVER_LIBRARY
from service.problems import Problem
from service.storage.files import Storage
from service.tables.kept import Kept
from service.tables.stored import Stored


def _built_in() -> list[DriverOut]:
    return [DriverOut.built_in(performance) for performance in built_in.performances()]


PRESENTED_DRIVERS = Presentation(DRIVER_LIBRARY, Segments, _built_in, DriverOut.own)


def stored(context: Context, owner: str, name: str) -> tuple[Stored, Storage]:
    """A driver's video, and where it lies: in the package, or in the service's storage."""
    file = file_of(context, DRIVER_LIBRARY, owner, name)
    if file is not None:
        return file.stored, context.storage
    if name in DRIVER_LIBRARY.built_in:
        return _installed(built_in.item(DRIVER_LIBRARY.name, name), "video/mp4")
    raise not_found_problem(DRIVER_LIBRARY)


def poster(context: Context, owner: str, name: str) -> tuple[Stored, Storage]:
    """The small picture that shows a driver; of the user's own, the search for segments takes it: nothing is decoded
    outside of jobs."""
    with context.database.read() as session:
        driver = repository.get(session, DRIVER_LIBRARY, owner, name)
    if driver is None and name in DRIVER_LIBRARY.built_in:
        return _installed(built_in.picture(DRIVER_LIBRARY.name, name), "image/jpeg")
    return _picture(context, driver, POSTER_NAME)


def segment_poster(context: Context, owner: str, name: str, segment_name: str) -> tuple[Stored, Storage]:
    """The small picture that shows one segment of a driver of the user's own."""
    with context.database.read() as session:
        driver = repository.get(session, DRIVER_LIBRARY, owner, name)
    if driver is not None:
        inspection = of_drivers(context, [driver])[name]
        if segment_name not in [one.name for one in segments(inspection)]:
            raise missing_segment(name, segment_name)
    return _picture(context, driver, f"{segment_name}.jpg")


def _picture(context: Context, driver: Kept | None, artifact: str) -> tuple[Stored, Storage]:
    if driver is None:
        raise not_found_problem(DRIVER_LIBRARY)
    with context.database.read() as session:
        found = artifacts.get(session, driver.inspection_job, artifact) if driver.inspection_job is not None else None
    if found is None:
        raise Problem(404, "poster_not_found", "There is no picture of this driver (yet): show the video instead.")
    return found.stored, context.storage


def _installed(path: Path, content_type: str) -> tuple[Stored, Storage]:
    status = path.stat()
    modified = datetime.fromtimestamp(status.st_mtime, UTC)
    return Stored(path.name, path.name, content_type, status.st_size, content_hash(path), modified), Storage(
        path.parent
    )
