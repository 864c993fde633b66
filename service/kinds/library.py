"""Built-in libraries, by the names that inputs of job kinds give them."""

from __future__ import annotations

from pathlib import Path


def names(library: str) -> tuple[str, ...]:
    """What a library holds."""
    if library != "performances":
        return ()
    from engine import performances

    return tuple(performances.names())


def item(library: str, name: str) -> Path:
    """The file of one of a library's items; making it takes a while where it is not there yet."""
    if name not in names(library):
        raise KeyError(f"{library}: {name}")
    from engine import performances

    return performances.video(name)
