"""The libraries: in each, users keep files under names beside the built-in things of the same sort."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from engine.media.sniff import MOTION_TYPES, VIDEO_TYPES
from service.catalogue import built_in
from service.tables.kept import Driver, Kept, Motion


@dataclass(frozen=True)
class Library:
    """A library, and how it is spoken of."""

    name: str
    """By which inputs of job kinds ask for it."""
    table: type[Kept]
    noun: str
    """What one of the things is called: by clients, in codes of problems, and as the input of the job that inspects it."""
    media: str
    """What its file has to be, in words."""
    media_types: frozenset[str]
    kind: str
    """The job kind that inspects what is new here."""
    document: str
    """The artifact in which that job says what it found."""

    @property
    def built_in(self) -> tuple[str, ...]:
        """The names of what is built in."""
        return built_in.names(self.name)

    @property
    def address(self) -> str:
        """Where the API has it."""
        return f"/v1/{self.noun}s"


DRIVER_LIBRARY = Library("performances", Driver, "driver", "a video", VIDEO_TYPES, "moments", "moments.json")
MOTION_LIBRARY = Library("motions", Motion, "motion", "a BVH, GLB or glTF file", MOTION_TYPES, "motion", "motion.json")

LIBRARIES: Mapping[str, Library] = {library.name: library for library in (DRIVER_LIBRARY, MOTION_LIBRARY)}
"""All libraries, by their names."""
