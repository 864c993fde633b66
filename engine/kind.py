"""What a job kind is: its inputs, its options, and the function that does the work.

A system offers itself to shell, service and worker as one `Kind`; `engine.kinds` lists them. Adding a
system is adding its folder and one line there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import BaseModel

from engine.run import Run


@dataclass(frozen=True)
class Input:
    """One named input of a kind."""

    name: str
    media: Literal["image", "video", "motion"]
    description: str
    required: bool = True
    many: bool = False
    library: Literal["performances"] | None = None
    """Where set, the input may also be the name of an item of that built-in library."""


@dataclass(frozen=True)
class Kind:
    """A job kind. `work(inputs, options, out, run)` leaves its artifacts in the existing folder `out`.

    `inputs` maps an input's name to a local file (a tuple of files where `many`). The media types and
    limits were not looked at before: `work` probes them itself and raises `InputError`.
    """

    name: str
    summary: str
    inputs: tuple[Input, ...]
    options: type[BaseModel]
    work: Callable[[Mapping[str, Path | tuple[Path, ...]], BaseModel, Path, Run], None]
    prepare: Callable[[], None] | None = None
    """Imports what `work` needs: called by a process that will do the work, so that importing a kind is cheap."""
