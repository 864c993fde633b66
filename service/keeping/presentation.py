"""How the API shows what is in a library: what is built in, then what the user keeps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from pydantic import BaseModel

from service.context import Context
from service.keeping.service import not_found_problem
from service.libraries import repository
from service.libraries.inspections import Inspection, inspections_of
from service.libraries.library import Library
from service.tables.files import File
from service.tables.kept import Kept


class Named(Protocol):
    """What is shown of one thing."""

    name: str


Item = TypeVar("Item", bound=Named)
D = TypeVar("D", bound=BaseModel)


@dataclass(frozen=True)
class Presentation(Generic[Item, D]):
    """How one library is shown."""

    library: Library
    document: type[D]
    """What its inspections write."""
    built_in: Callable[[], Sequence[Item]]
    """What is built in, as it is shown."""
    own: Callable[[Kept, File, Inspection[D]], Item]
    """How a file of the user's own is shown, with what was found in it."""


def list_items(context: Context, presented: Presentation[Item, D], owner: str) -> list[Item]:
    """What is in a library. What was kept before there was something built in of its name goes before that."""
    library = presented.library
    with context.database.read() as session:
        own = repository.with_files(session, library, owner)
    found = inspections_of(context, library, presented.document, [kept for kept, _ in own])
    hidden = {kept.name for kept, _ in own}
    built_in = [item for item in presented.built_in() if item.name not in hidden]
    return [*built_in, *(presented.own(kept, file, found[kept.name]) for kept, file in own)]


def get_item(context: Context, presented: Presentation[Item, D], owner: str, name: str) -> Item:
    """What is in a library under a name. Raises a 404 problem."""
    for item in list_items(context, presented, owner):
        if item.name == name:
            return item
    raise not_found_problem(presented.library)
