"""What clients can do with drivers."""

from __future__ import annotations

import re
from datetime import UTC, datetime

from sqlalchemy.exc import IntegrityError

from engine.run import content_hash
from service.artifacts.delivery import Stored
from service.clock import now
from service.context import Context
from service.drivers import repository
from service.drivers.models import Driver
from service.drivers.schemas import DriverOut
from service.files import repository as files
from service.files.models import File
from service.files.service import erase_unused
from service.ids import is_id
from service.kinds import library
from service.problems import Problem
from service.storage import Storage

NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,62}")
LIBRARY = "performances"
"""The built-in drivers."""

RESERVED = ("auto",)
"""Names with a meaning of their own where a driver is named."""


def all_drivers(context: Context) -> list[DriverOut]:
    """The built-in performances and the user's own drivers."""
    with context.database.read() as session:
        own = repository.with_files(session)
    return [*map(DriverOut.built_in, library.performances()), *(DriverOut.own(driver, file) for driver, file in own)]


def require_free_name(context: Context, name: str) -> None:
    """Raise a problem if no driver can have this name."""
    if NAME.fullmatch(name) is None or is_id(name):
        raise Problem(
            422,
            "invalid_name",
            "A driver's name has 1 to 63 of the characters a-z, 0-9, - and _, a letter or digit first.",
        )
    with context.database.read() as session:
        if name in RESERVED or name in library.names(LIBRARY) or repository.get(session, name) is not None:
            raise _taken(name)


def keep(context: Context, name: str, file: File) -> DriverOut:
    """Keep a file as a driver."""
    driver = Driver(name=name, file_id=file.id, created_at=now())
    try:
        with context.database.write() as session:
            session.add(driver)
    except IntegrityError as error:
        raise _taken(name) from error
    return DriverOut.own(driver, file)


def delete(context: Context, name: str) -> None:
    """Erase one of the user's own drivers."""
    if name in library.names(LIBRARY):
        raise Problem(409, "driver_built_in", "Built-in performances cannot be deleted.")
    with context.database.write() as session:
        driver = repository.get(session, name)
        if driver is None:
            raise _missing()
        repository.erase(session, name)
    erase_unused(context, [driver.file_id])


def stored(context: Context, name: str) -> tuple[Stored, Storage]:
    """A driver's video, and where it lies: in the package, or in the service's storage."""
    if name in library.names(LIBRARY):
        path = library.item(LIBRARY, name)
        status = path.stat()
        modified = datetime.fromtimestamp(status.st_mtime, UTC)
        built_in = Stored(path.name, path.name, "video/mp4", status.st_size, content_hash(path), modified)
        return built_in, Storage(path.parent)
    with context.database.read() as session:
        driver = repository.get(session, name)
        file = files.get(session, driver.file_id) if driver is not None else None
    if file is None:
        raise _missing()
    return file.stored, context.storage


def _taken(name: str) -> Problem:
    return Problem(409, "name_taken", f"There is a driver “{name}” already: choose another name or delete that one.")


def _missing() -> Problem:
    return Problem(404, "driver_not_found", "There is no driver of this name.")
