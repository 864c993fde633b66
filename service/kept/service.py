"""Keeping files under names, and erasing them."""

from __future__ import annotations

import re

from sqlalchemy.exc import IntegrityError

from engine.kind import AUTO
from service.clock import now
from service.context import Context
from service.files import repository as files
from service.files.service import erase_unused
from service.ids import is_id
from service.jobs.inputs import Refused, held_file
from service.kept import looks, repository
from service.kept.shelves import Shelf
from service.problems import FieldError, Problem
from service.tables.files import File
from service.tables.kept import Kept

NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,62}")

RESERVED = (AUTO,)
"""Names with a meaning of their own where something kept is named."""


def require_free_name(context: Context, shelf: Shelf, owner: str, name: str) -> None:
    """Raise a problem if nothing can be kept under this name."""
    if NAME.fullmatch(name) is None or is_id(name):
        raise Problem(
            422,
            "invalid_name",
            f"A {shelf.noun}'s name has 1 to 63 of the characters a-z, 0-9, - and _, a letter or digit first.",
        )
    with context.database.read() as session:
        if name in RESERVED or name in shelf.built_in or repository.get(session, shelf, owner, name) is not None:
            raise _taken(shelf, name)


def require_media(shelf: Shelf, content_type: str) -> None:
    """Raise a 415 problem if a file is not what is kept there."""
    if content_type not in shelf.media_types:
        raise Problem(415, "input_wrong_media", f"A {shelf.noun} is {shelf.media}; this is {content_type}.")


def keep(context: Context, shelf: Shelf, owner: str, name: str, file_id: str) -> None:
    """Keep a file of the owner's under a name, and have a job look into it. Raises `Problem`."""
    try:
        with context.database.write() as session:
            file = held_file(session, owner, file_id, shelf.noun)
            require_media(shelf, file.content_type)
            session.add(shelf.table(owner=owner, name=name, file_id=file_id, created_at=now()))
    except Refused as refused:
        error = FieldError(pointer="/file", code=refused.code, detail=refused.detail)
        raise Problem(422, refused.code, refused.detail, [error]) from refused
    except IntegrityError as error:
        raise _taken(shelf, name) from error
    looks.look_into(context, shelf, owner, name, file_id)


def kept(context: Context, shelf: Shelf, owner: str, name: str) -> Kept:
    """What the owner keeps under a name. Raises a 404 problem, or 409 where it is a built-in thing."""
    with context.database.read() as session:
        found = repository.get(session, shelf, owner, name)
    if found is None:
        raise _not_kept(shelf, name)
    return found


def file_of(context: Context, shelf: Shelf, owner: str, name: str) -> File | None:
    """The file that the owner keeps under a name, if there is one."""
    with context.database.read() as session:
        one = repository.get(session, shelf, owner, name)
        return files.get(session, owner, one.file_id) if one is not None else None


def look_again(context: Context, shelf: Shelf, owner: str, name: str) -> None:
    """Look into a kept file, anew where that was done before; one look at a time. Raises `Problem`."""
    one = kept(context, shelf, owner, name)
    if not looks.under_way(context, one):
        looks.begin(context, shelf, owner, name, one.file_id)
        looks.forget(context, owner, one.look_job)


def rename(context: Context, shelf: Shelf, owner: str, name: str, new: str) -> None:
    """Give what an owner keeps another name. Jobs go by its file, and what was found in it by the job that looked:
    none of that changes. Raises `Problem`."""
    kept(context, shelf, owner, name)
    if new == name:
        return
    require_free_name(context, shelf, owner, new)
    try:
        with context.database.write() as session:
            if not repository.rename(session, shelf, owner, name, new):
                raise _not_kept(shelf, name)
    except IntegrityError as error:
        raise _taken(shelf, new) from error


def delete(context: Context, shelf: Shelf, owner: str, name: str) -> None:
    """Erase what an owner keeps under a name, with all that was found in it. Raises `Problem`."""
    with context.database.write() as session:
        one = repository.get(session, shelf, owner, name)
        if one is None:
            raise _not_kept(shelf, name)
        repository.erase(session, shelf, owner, name)
    looks.forget(context, owner, one.look_job)
    erase_unused(context, [one.file_id])


def missing(shelf: Shelf) -> Problem:
    return Problem(404, f"{shelf.noun}_not_found", f"There is no {shelf.noun} of this name.")


def _not_kept(shelf: Shelf, name: str) -> Problem:
    if name in shelf.built_in:
        detail = f"Nothing of what is built in can be renamed, deleted or looked into: “{name}” is."
        return Problem(409, f"{shelf.noun}_built_in", detail)
    return missing(shelf)


def _taken(shelf: Shelf, name: str) -> Problem:
    detail = f"There is a {shelf.noun} “{name}” already: choose another name or delete that one."
    return Problem(409, "name_taken", detail)
