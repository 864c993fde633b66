"""Small pictures of one size, frame after frame in one file: JPEG, so that hours of video stay on the disk."""

from __future__ import annotations

import tempfile
import weakref
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

import cv2
import numpy as np
from numpy.typing import NDArray

STRIP_JPEG_QUALITY = 92


@dataclass(frozen=True)
class FilmStrip:
    """`file` holds the pictures, `ends` (N,) where in it each of them ends; those of `ending` (M, ...) stand in the
    place of its last M."""

    file: Path
    ends: NDArray[np.int64]
    ending: NDArray[np.uint8] = field(default_factory=lambda: np.zeros(0, np.uint8))

    def __len__(self) -> int:
        return len(self.ends)

    def picture(self, frame: int) -> NDArray[np.uint8]:
        """One of them: uint8, (h, w, 3) or (h, w)."""
        if (late := frame - len(self) + len(self.ending)) >= 0:
            return np.asarray(self.ending[late], np.uint8)
        start = int(self.ends[frame - 1]) if frame else 0
        with self.file.open("rb") as file:
            file.seek(start)
            data = np.frombuffer(file.read(int(self.ends[frame]) - start), np.uint8)
        decoded = np.asarray(cv2.imdecode(data, cv2.IMREAD_UNCHANGED), np.uint8)
        return decoded if decoded.ndim == 2 else np.asarray(cv2.cvtColor(decoded, cv2.COLOR_BGR2RGB), np.uint8)


class FilmStripWriter:
    """Writes a strip, picture by picture, to a temporary file; use in a `with` statement, which erases it on errors."""

    def __init__(self, quality: int = STRIP_JPEG_QUALITY):
        self._file = tempfile.NamedTemporaryFile(prefix="galatea-", suffix=".jpegs", delete=False)  # noqa: SIM115
        self._quality = quality
        self._ends: list[int] = []

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Append a picture, (h, w, 3) RGB or (h, w)."""
        bgr = picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
        done, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, self._quality])
        assert done
        self._file.write(data.tobytes())
        self._ends.append(self._file.tell())

    def strip(self) -> FilmStrip:
        """All that was written; its file goes with it, if it was not moved away by then."""
        self._file.flush()
        path = Path(self._file.name)
        strip = FilmStrip(path, np.array(self._ends, np.int64))
        weakref.finalize(strip, path.unlink, missing_ok=True)
        return strip

    def __enter__(self) -> FilmStripWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()
        if error is not None:
            Path(self._file.name).unlink(missing_ok=True)
