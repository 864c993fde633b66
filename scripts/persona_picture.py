"""The picture of docs/personas.md: one photo acting by itself, and as a persona of all of them, beside the performance.

The photos are the project's own: the actor of the built-in performances.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized
from engine.media.image import read_image, write_image
from engine.media.video import probe_video, read_video
from engine.performances import video
from engine.persona.sample import write_sample_photos
from galatea import animate, make_persona

OUT_FILE = Path(__file__).parent.parent / "docs" / "pictures" / "persona.jpg"
SHOWN_PERFORMANCE_SECONDS = (("happy-strong", 1.0), ("surprise-strong", 1.25))
"""Performance, and seconds into it."""
CELL_WIDTH_PIXELS, CELL_HEIGHT_PIXELS = 240, 300
JPEG_QUALITY = 85


def main() -> None:
    """Write the picture: a row for each moment, the performance, the photo that acts alone, and the persona."""
    rows = []
    with TemporaryDirectory() as folder:
        home = Path(folder)
        (home / "photos").mkdir()
        photos = write_sample_photos(home / "photos")
        kept = make_persona(photos, None, home / "persona", photo=0).artifacts["persona.npz"]
        for name, seconds in SHOWN_PERFORMANCE_SECONDS:
            index = round(seconds * probe_video(video(name)).fps)
            alone = animate(
                photos[0], name, home / f"{name}-alone", size=(2 * CELL_WIDTH_PIXELS, 2 * CELL_HEIGHT_PIXELS)
            ).path
            acted = make_persona(
                kept, name, home / name, composite="photo", size=(2 * CELL_WIDTH_PIXELS, 2 * CELL_HEIGHT_PIXELS)
            ).path
            rows.append(np.hstack([_upright(_frame(path, index)) for path in (video(name), alone, acted)]))
        first = _upright(read_image(photos[0]).rgb, 2)
    write_image(OUT_FILE, np.hstack([first, np.vstack(rows)]), quality=JPEG_QUALITY)


def _frame(path: Path, index: int) -> NDArray[np.uint8]:
    return next(frame.rgb.copy() for number, frame in enumerate(read_video(path)) if number == index)


def _upright(rgb: NDArray[np.uint8], times: int = 1) -> NDArray[np.uint8]:
    """The middle of a picture, as large as a part of this one is, or `times` as large."""
    height, width = rgb.shape[:2]
    wide, high = (
        min(width, height * CELL_WIDTH_PIXELS // CELL_HEIGHT_PIXELS),
        min(height, width * CELL_HEIGHT_PIXELS // CELL_WIDTH_PIXELS),
    )
    left, top = (width - wide) // 2, (height - high) // 2
    return resized(
        np.ascontiguousarray(rgb[top : top + high, left : left + wide]),
        (CELL_WIDTH_PIXELS * times, CELL_HEIGHT_PIXELS * times),
    )


if __name__ == "__main__":
    main()
