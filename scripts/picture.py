"""`make picture`: the README's picture, a portrait that comes with matplotlib acting out built-in performances."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.media.image import write_image
from engine.media.video import probe_video, read_video
from engine.performances import video
from galatea import animate

OUT_FILE = Path(__file__).parent.parent / "docs" / "pictures" / "portrait.jpg"
SHOWN_PERFORMANCE_SECONDS = (("happy", 0.8), ("happy", 1.9), ("surprise", 1.25), ("surprise", 1.85))
"""Performance, and seconds into it."""
SIDE_PIXELS = 250
"""Of one frame, pixels; the portrait itself is twice as large."""
JPEG_QUALITY = 85


def main() -> None:
    """Write the picture: the portrait, and beside it the performances above, the portrait acting them out below."""
    package = find_spec("matplotlib")
    assert package is not None and package.origin is not None
    portrait = Path(package.origin).parent / "mpl-data/sample_data/grace_hopper.jpg"
    above, below = [], []
    with TemporaryDirectory() as folder:
        made = {
            name: _frames(
                animate(portrait, name, Path(folder) / name, crop="bust", size=(2 * SIDE_PIXELS, 2 * SIDE_PIXELS)).path
            )
            for name in {name for name, _ in SHOWN_PERFORMANCE_SECONDS}
        }
        for name, seconds in SHOWN_PERFORMANCE_SECONDS:
            index = round(seconds * probe_video(video(name)).fps)
            above.append(_square(_frames(video(name))[index]))
            below.append(_square(made[name][index]))
        still = _square(made["happy"][0], 2 * SIDE_PIXELS)
    OUT_FILE.parent.mkdir(parents=True, exist_ok=True)
    write_image(OUT_FILE, np.hstack([still, np.vstack([np.hstack(above), np.hstack(below)])]), quality=JPEG_QUALITY)


def _frames(path: Path) -> list[NDArray[np.uint8]]:
    return [frame.rgb.copy() for frame in read_video(path)]


def _square(rgb: NDArray[np.uint8], width: int = SIDE_PIXELS) -> NDArray[np.uint8]:
    side = min(rgb.shape[:2])
    left = (rgb.shape[1] - side) // 2
    part = np.ascontiguousarray(rgb[:side, left : left + side])
    return np.asarray(cv2.resize(part, (width, width), interpolation=cv2.INTER_AREA), np.uint8)


if __name__ == "__main__":
    main()
