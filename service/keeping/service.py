"""Keeping files under names, and erasing them."""

from __future__ import annotations

import re

from sqlalchemy.exc import IntegrityError

from engine.kind import AUTO_CHOICE
from service.clock import now
from service.context import Context
from service.files import repository as files
from service.files.service import erase_unused
from service.ids import is_id
from service.jobs.inputs import ValueRefused, held_file
from service.keeping import inspection_jobs
from service.libraries import repository
from service.libraries.library import Library
from service.problems import FieldError, Problem
from service.tables.files import File
from service.tables.kept import Kept

NAME_PATTERN = re.compile(r"[a-z0-9][a-z0-9_-]{0,62}")

RESERVED_NAMES = (AUTO_CHOICE,)
"""Names with a meaning of their own where something kept is named."""


def require_free_name(context: Context, library: Library, owner: str, name: str) -> None:
    """Raise a problem if nothing can be kept under this name."""
    if NAME_PATTERN.fullmatch(name) is None or is_id(name):
        raise Problem(
            422,
            "invalid_name",
            f"A {library.noun}'s name has 1 to 63 of the characters a-z, 0-9, - and _, a letter or digit first.",
        )
    with context.database.read() as session:
        if (
            name in RESERVED_NAMES
            or name in library.built_in
            or repository.get(session, library, owner, name) is not None
        ):
            raise _taken(library, name)


def require_media(library: Library, content_type: str) -> None:
    """Raise a 415 problem if a file is not what is kept there."""
    if content_type not in library.media_types:
        raise Problem(415, "input_wrong_media", f"A {library.noun} is {library.media}; this is {content_type}.")


def keep(context: Context, library: Library, owner: str, name: str, file_id: str) -> None:
    """Keep a file of the owner's under a name, and have a job inspect it. Raises `Problem`."""
    try:
        with context.database.write() as session:
            file = held_file(session, owner, file_id, library.noun)
            require_media(library, file.content_type)
            session.add(library.table(owner=owner, name=name, file_id=file_id, created_at=now()))
    except ValueRefused as refused:
        error = FieldError(pointer="/file", code=refused.code, detail=refused.detail)
        raise Problem(422, refused.code, refused.detail, [error]) from refused
    except IntegrityError as error:
        raise _taken(library, name) from error
    inspection_jobs.inspect_new(context, library, owner, name, file_id)


def get_kept(context: Context, library: Library, owner: str, name: str) -> Kept:
    """What the owner keeps under a name. Raises a 404 problem, or 409 where it is a built-in thing."""
    with context.database.read() as session:
        found = repository.get(session, library, owner, name)
    if found is None:
        raise _not_kept(library, name)
    return found


def file_of(context: Context, library: Library, owner: str, name: str) -> File | None:
    """The file that the owner keeps under a name, if there is one."""
    with context.database.read() as session:
        one = repository.get(session, library, owner, name)
        return files.get(session, owner, one.file_id) if one is not None else None


def inspect_again(context: Context, library: Library, owner: str, name: str) -> None:
    """Inspect a kept file, anew where that was done before; one inspection at a time. Raises `Problem`."""
    one = get_kept(context, library, owner, name)
    if not inspection_jobs.under_way(context, one):
        inspection_jobs.begin(context, library, owner, name, one.file_id)
        inspection_jobs.forget(context, owner, one.inspection_job)


def rename(context: Context, library: Library, owner: str, name: str, new: str) -> None:
    """Give what an owner keeps another name. Jobs go by its file, and what was found in it by the job that inspected it:
    none of that changes. Raises `Problem`."""
    get_kept(context, library, owner, name)
    if new == name:
        return
    require_free_name(context, library, owner, new)
    try:
        with context.database.write() as session:
            if not repository.rename(session, library, owner, name, new):
                raise _not_kept(library, name)
    except IntegrityError as error:
        raise _taken(library, new) from error


def delete(context: Context, library: Library, owner: str, name: str) -> None:
    """Erase what an owner keeps under a name, with all that was found in it. Raises `Problem`."""
    with context.database.write() as session:
        one = repository.get(session, library, owner, name)
        if one is None:
            raise _not_kept(library, name)
        repository.erase(session, library, owner, name)
    inspection_jobs.forget(context, owner, one.inspection_job)
    erase_unused(context, [one.file_id])


def not_found_problem(library: Library) -> Problem:
    return Problem(404, f"{library.noun}_not_found", f"There is no {library.noun} of this name.")


def _not_kept(library: Library, name: str) -> Problem:
    if name in library.built_in:
        detail = f"Nothing of what is built in can be renamed, deleted or looked into: “{name}” is."
        return Problem(409, f"{library.noun}_built_in", detail)
    return not_found_problem(library)


def _taken(library: Library, name: str) -> Problem:
    detail = f"There is a {library.noun} “{name}” already: choose another name or delete that one."
    return Problem(409, "name_taken", detail)
