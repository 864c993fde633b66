"""What clients can see of drivers; keeping and erasing them is as with all that is kept (`service.kept`)."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from engine.run import content_hash
from service.artifacts import repository as artifacts
from service.context import Context
from service.drivers import moments
from service.drivers.schemas import DriverOut
from service.kept import repository
from service.kept.service import file_of, missing
from service.kept.shelves import DRIVERS
from service.kinds import library
from service.problems import Problem
from service.storage import Storage
from service.tables.kept import Kept
from service.tables.stored import Stored


def all_drivers(context: Context, owner: str) -> list[DriverOut]:
    """The built-in performances and the user's own drivers. One that was kept before the library had a performance of
    its name goes before it."""
    with context.database.read() as session:
        own = repository.with_files(session, DRIVERS, owner)
    found = moments.of_drivers(context, [driver for driver, _ in own])
    hidden = {driver.name for driver, _ in own}
    built_in = [DriverOut.built_in(one) for one in library.performances() if one.name not in hidden]
    return [*built_in, *(DriverOut.own(driver, file, found[driver.name]) for driver, file in own)]


def one_driver(context: Context, owner: str, name: str) -> DriverOut:
    """The driver of that name."""
    for driver in all_drivers(context, owner):
        if driver.name == name:
            return driver
    raise missing(DRIVERS)


def stored(context: Context, owner: str, name: str) -> tuple[Stored, Storage]:
    """A driver's video, and where it lies: in the package, or in the service's storage."""
    file = file_of(context, DRIVERS, owner, name)
    if file is not None:
        return file.stored, context.storage
    if name in DRIVERS.built_in:
        return _installed(library.item(DRIVERS.library, name), "video/mp4")
    raise missing(DRIVERS)


def poster(context: Context, owner: str, name: str) -> tuple[Stored, Storage]:
    """The small picture that shows a driver; of the user's own, the search for moments takes it: nothing is decoded
    outside of jobs."""
    with context.database.read() as session:
        driver = repository.get(session, DRIVERS, owner, name)
    if driver is None and name in DRIVERS.built_in:
        return _installed(library.picture(DRIVERS.library, name), "image/jpeg")
    return _picture(context, driver, moments.POSTER)


def moment_poster(context: Context, owner: str, name: str, moment: str) -> tuple[Stored, Storage]:
    """The small picture that shows one moment of a driver of the user's own."""
    with context.database.read() as session:
        driver = repository.get(session, DRIVERS, owner, name)
    if driver is not None:
        look = moments.of_drivers(context, [driver])[name]
        if moment not in [one.name for one in moments.portions(look)]:
            raise moments.missing(name, moment)
    return _picture(context, driver, f"{moment}.jpg")


def _picture(context: Context, driver: Kept | None, artifact: str) -> tuple[Stored, Storage]:
    if driver is None:
        raise missing(DRIVERS)
    with context.database.read() as session:
        found = artifacts.get(session, driver.look_job, artifact) if driver.look_job is not None else None
    if found is None:
        raise Problem(404, "poster_not_found", "There is no picture of this driver (yet): show the video instead.")
    return found.stored, context.storage


def _installed(path: Path, content_type: str) -> tuple[Stored, Storage]:
    status = path.stat()
    modified = datetime.fromtimestamp(status.st_mtime, UTC)
    return Stored(path.name, path.name, content_type, status.st_size, content_hash(path), modified), Storage(
        path.parent
    )
