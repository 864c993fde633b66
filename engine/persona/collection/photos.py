"""The photographs of a collection: files and archives of files, kept as they are looked at."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.media.archive import is_archive, unpack_pictures
from engine.media.film_strip import FilmStrip, FilmStripWriter
from engine.media.image import over_grey, read_image
from engine.media.limits import Limits
from engine.persona.collection.photo_face import as_looked_at

MAX_COLLECTION_PHOTOS = 800
"""Of a collection: three hundred are more than enough."""
PHOTO_JPEG_QUALITY = 95


@dataclass(frozen=True)
class SkippedFile:
    """A file that is no photograph that can be read: its name, and the code of why."""

    name: str
    code: str


@dataclass(frozen=True)
class Photos:
    """strip : the N photographs, upright, as they are looked at.
    names : of their files.
    years : in which they were taken, None where a file does not say.
    skipped : files that are none.
    """

    strip: FilmStrip
    names: tuple[str, ...]
    years: tuple[int | None, ...]
    skipped: tuple[SkippedFile, ...]

    def __len__(self) -> int:
        return len(self.names)

    def picture(self, photo: int) -> NDArray[np.uint8]:
        """(h, w, 3) uint8 one of them."""
        return self.strip.picture(photo)


def read_photos(paths: Sequence[Path], limits: Limits, tick: Callable[[float], None] = lambda fraction: None) -> Photos:
    """All photographs among files and archives. What cannot be read is skipped, and listed.

    Raises
    ------
    InputError : `too_many_photos`, and what `unpack_pictures` raises of an archive.
    """
    names: list[str] = []
    years: list[int | None] = []
    skipped: list[SkippedFile] = []
    with tempfile.TemporaryDirectory(prefix="galatea-") as folder, FilmStripWriter(PHOTO_JPEG_QUALITY) as writer:
        files = list(_files(paths, Path(folder)))
        if len(files) > MAX_COLLECTION_PHOTOS:
            raise InputError(
                "too_many_photos", f"These are {len(files)} photos; send {MAX_COLLECTION_PHOTOS} at most.", ("photos",)
            )
        for number, (path, name) in enumerate(files):
            try:
                picture = read_image(path, limits)
                writer.write(np.ascontiguousarray(as_looked_at(over_grey(picture.rgb, picture.alpha))))
                names.append(name)
                years.append(picture.year)
            except InputError as error:
                skipped.append(SkippedFile(name, error.code))
            tick((number + 1) / len(files))
        return Photos(writer.strip(), tuple(names), tuple(years), tuple(skipped))


def _files(paths: Sequence[Path], folder: Path) -> Iterator[tuple[Path, str]]:
    for number, path in enumerate(paths):
        if path.stat().st_size and is_archive(path):
            room = folder / str(number)
            room.mkdir()
            yield from ((one.path, one.name) for one in unpack_pictures(path, room))
        else:
            yield path, path.name
