"""What a job kind is: its inputs, its options, and the function that does the work.

A system offers itself to shell, service and worker as one `Kind`; `engine.kinds` lists them. Adding a
system is adding its folder and one line there.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import BaseModel

from engine.run import Run


@dataclass(frozen=True)
class Input:
    """One named input of a kind."""

    name: str
    media: Literal["image", "video", "motion", "model", "photos", "performance", "persona"]
    """`photos` are pictures, and archives of pictures; a `performance` is a video, or one picture."""
    description: str
    required: bool = True
    many: bool = False
    serves_many: bool = False
    """Whether its analysis is worth keeping for further jobs: stages marked `shared` look at nothing but this input."""
    library: Literal["performances", "motions"] | None = None
    """Where set, the input may also be the name of an item of that library: the built-in one, or what a user keeps."""
    offers_auto: bool = True
    """Whether such a library's item may be left to the work to choose."""
    trimmed_by: str | None = None
    """Where set, the option of this name holds which part of the input is used, [start, end] in seconds: a driver's
    moment can be named then (`myclip/happy`), which sets it."""
    spared_by: str | None = None
    """Where set, the option of this name makes the input one that may be left out."""
    spared_by_input: str | None = None
    """Where set, the input of this name, given instead, makes the input one that may be left out."""
    personal: bool = False
    """Shows somebody as they are: an operator may have it erased once the job has succeeded. Only stored stages may read it then."""
    artifact: str | None = None
    """Where set, the input may also be an earlier job of the same kind, by its id: the artifact of this name that it left."""
    erased_together: bool = False
    """Whether a job that takes it from an earlier job is erased with that one: it shows the same person."""
    named_by: str | None = None
    """Where set, the option of this name names something built in that stands in for the input: in a shell either may
    be given in its place."""
    corrects: bool = False
    """A revision may give it, or take it back, as a correction: a picture painted by hand of what the work found."""

    @property
    def auto(self) -> bool:
        """Whether `auto` may be given: the work chooses among the library's files then."""
        return self.library is not None and self.named_by is None and self.offers_auto

    @property
    def always_needed(self) -> bool:
        """Whether there is no job without it."""
        return self.required and self.spared_by is None and self.spared_by_input is None

    def needed(self, options: BaseModel, given: Container[str] = ()) -> bool:
        """Whether a job with these options, and inputs of the names `given`, must have the input."""
        spared = self.spared_by is not None and getattr(options, self.spared_by)
        return self.required and not spared and self.spared_by_input not in given


@dataclass(frozen=True)
class Candidates:
    """Files by name, of which the system itself takes the one that fits best: what `auto` stands for."""

    files: Mapping[str, Path]


Given = Path | tuple[Path, ...] | Candidates
"""What an input can be when the work begins."""

AUTO_CHOICE = "auto"
"""The name by which an input with a library asks for that choice."""


@dataclass(frozen=True)
class Needs:
    """What a kind's work takes at the most. The operator's settings cap all of it, and None leaves it to them.

    seconds : of work, on a machine that is slow or has other things to do; longer is a fault, or a hostile input.
    memory_mb : in millions of bytes.
    cores : that it can make use of.
    """

    seconds: float | None = None
    memory_mb: float | None = None
    cores: int | None = None
    short: bool = False
    """Whether a job usually takes seconds: it does not wait behind those that take minutes then."""


@dataclass(frozen=True)
class Kind:
    """A job kind. `work(inputs, options, out, run)` leaves its artifacts in the existing folder `out`.

    `inputs` maps an input's name to a local file (a tuple of files where `many`, `Candidates` where it was `auto`).
    The media types and limits were not looked at before: `work` probes them itself and raises `InputError`.
    """

    name: str
    summary: str
    inputs: tuple[Input, ...]
    options: type[BaseModel]
    work: Callable[[Mapping[str, Given], BaseModel, Path, Run], None]
    correctable: tuple[str, ...] = ()
    """The options that correct what the work found by itself: a revision may set them as corrections."""
    prepare: Callable[[], None] | None = None
    """Imports what `work` needs: called by a process that will do the work, so that importing a kind is cheap."""
    rehearse: Callable[[Path], None] | None = None
    """Does the work once in an empty folder, on media of the project's own, so that all that is compiled at its first
    use is compiled and kept."""
    needs: Needs = Needs()
