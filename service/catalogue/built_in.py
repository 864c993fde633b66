"""Built-in libraries, by the names that inputs of job kinds give them."""

from __future__ import annotations

from pathlib import Path

from engine.motion.catalogue import CATALOGUE
from engine.performances import Performance, catalogue, poster, video


def performances() -> tuple[Performance, ...]:
    """The built-in performances whose video is installed (`galatea doctor` tells of missing ones)."""

    def installed(one: Performance) -> bool:
        try:
            return video(one.name).is_file()
        except FileNotFoundError:
            return False

    return tuple(filter(installed, catalogue()))


def names(library: str) -> tuple[str, ...]:
    """What a library holds."""
    if library == "motions":
        return tuple(one.name for one in CATALOGUE)
    return tuple(one.name for one in performances()) if library == "performances" else ()


def item(library: str, name: str) -> Path:
    """The file of one of a library's items; built-in motions have none."""
    if library != "performances" or name not in names(library):
        raise KeyError(f"{library}: {name}")
    return video(name)


def picture(library: str, name: str) -> Path:
    """The small picture that shows one of a library's items."""
    if library != "performances" or name not in names(library):
        raise KeyError(f"{library}: {name}")
    return poster(name)
