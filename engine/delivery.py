"""A kind's work whose artifacts are all there in the end, or none of them."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

from pydantic import BaseModel

from engine.kind import Given, Kind
from engine.run import Run


def deliver(kind: Kind, inputs: Mapping[str, Given], options: BaseModel, out: Path, run: Run) -> list[Path]:
    """Do the work of a kind; returns its artifacts, which are in the folder `out` then, by name.

    Where the work is refused or breaks off, `out` is left as it was: no part of a result, and no folder that was made for it.

    Raises
    ------
    InputError, Canceled : as the work does.
    OSError : the folder cannot be made or written.
    """
    with _folder(out), TemporaryDirectory(prefix=".galatea-", dir=out) as draft:
        kind.work(inputs, options, Path(draft), run)
        return [Path(shutil.move(made, out / made.name)) for made in sorted(Path(draft).iterdir())]


@contextmanager
def _folder(folder: Path) -> Iterator[None]:
    """Within, the folder is there; what had to be made for it is taken away again where that ends by an error."""
    made = [one for one in (folder, *folder.parents) if not one.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    try:
        yield
    except BaseException:
        with suppress(OSError):  # somebody else has put something in
            for one in made:
                one.rmdir()
        raise
