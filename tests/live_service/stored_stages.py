"""Whether a later run took what stages of an earlier one had left in their store, told by the files themselves."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Stored:
    """When an output of a stage was written, and when it was last asked for, nanoseconds."""

    written: int
    used: int


def stored(folder: Path) -> dict[str, Stored]:
    """The outputs in a store of stages by their keys; a store says by a folder's time when it was used."""
    outputs = [path for path in folder.glob("*/output.json") if not path.parent.name.startswith(".")]
    return {path.parent.name: Stored(path.stat().st_mtime_ns, path.parent.stat().st_mtime_ns) for path in outputs}


def assert_taken(before: dict[str, Stored], after: dict[str, Stored]) -> None:
    """Each output that was there before was asked for since, and none was made anew."""
    for key, one in before.items():
        assert after[key].written == one.written, "it was written again"
        assert after[key].used > one.used, "it was not asked for"
