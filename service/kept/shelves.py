"""The shelves on which users keep files under names, each beside a built-in library of the same things."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.media.sniff import MOTION_TYPES, VIDEO_TYPES
from service.kinds import library
from service.tables.kept import Driver, Kept, Motion


@dataclass(frozen=True)
class Shelf:
    """What is kept in one place, and how it is spoken of."""

    library: str
    """The built-in library; inputs of job kinds that name it take what is kept here, too."""
    table: type[Kept]
    noun: str
    """What one of the things is called: by clients, in codes of problems, and as the input of the job that looks in."""
    media: str
    """What its file has to be, in words."""
    media_types: frozenset[str]
    kind: str
    """The job kind that looks into what is new here."""
    document: str
    """The artifact in which that job says what it found."""

    @property
    def built_in(self) -> tuple[str, ...]:
        """The names that the library has."""
        return library.names(self.library)

    @property
    def address(self) -> str:
        """Where the API has it."""
        return f"/v1/{self.noun}s"


DRIVERS = Shelf("performances", Driver, "driver", "a video", VIDEO_TYPES, "moments", "moments.json")
MOTIONS = Shelf("motions", Motion, "motion", "a BVH, GLB or glTF file", MOTION_TYPES, "motion", "motion.json")

SHELVES: Mapping[str, Shelf] = {shelf.library: shelf for shelf in (DRIVERS, MOTIONS)}
"""By the names of their libraries."""
