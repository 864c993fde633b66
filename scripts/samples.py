"""`make samples`: the pictures that the start pages offer to try, and the clips that move there on arrival.

The pictures that are ours or in the public domain alone: see `docs/licences.md`. Everything lands in
`web/public/samples/`, which the service hands out under `/samples/`.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.media.image import read_image, write_image
from engine.media.video import probe_video, read_video
from galatea import animate, wake_up
from scripts.sample_figures import SAMPLE_FIGURES, paint_figure
from scripts.sample_portraits import painted_actor, rendered_actor

OUT_FOLDER = Path(__file__).parent.parent / "web" / "public" / "samples"
JPEG_QUALITY = 90
THUMBNAIL_PIXELS = 176
"""Side of the small squares by which a sample is chosen, pixels: twice what they measure on the page."""
CROPPED_HEIGHT_PIXELS = 600
"""Height of a picture of which a part is taken, pixels: faces are to be seen well."""
SMALL_FIGURE_SIZE_PIXELS = (176, 235)
"""Width and height of the small pictures of whole figures, which show all of the picture."""
CLIP_SIZE, FIGURE_CLIP_SIZE = (400, 480), (400, 532)
"""Width and height of the clips on the start pages."""
CLIP_CRF = 25


@dataclass(frozen=True)
class Found:
    """A picture in the public domain that an installed package carries.

    face : middle and height of the small square, as shares of the picture's width and height.
    part : what of it is taken, (x, y, width, height) in pixels.
    """

    name: str
    package: str
    path: str
    face: tuple[float, float, float]
    part: tuple[int, int, int, int] | None = None

    def picture(self) -> NDArray[np.uint8]:
        spec = find_spec(self.package)
        assert spec is not None and spec.origin is not None, f"needs {self.package}: make tools"
        whole = read_image(Path(spec.origin).parent / self.path).rgb
        if self.part is None:
            return whole
        left, top, width, height = self.part
        part = np.ascontiguousarray(whole[top : top + height, left : left + width])
        size = (round(width * CROPPED_HEIGHT_PIXELS / height), CROPPED_HEIGHT_PIXELS)
        return np.asarray(cv2.resize(part, size, interpolation=cv2.INTER_LANCZOS4), np.uint8)


SAMPLE_PORTRAITS = (
    Found("grace-hopper", "matplotlib", "mpl-data/sample_data/grace_hopper.jpg", (0.5, 0.33, 0.66)),
    Found("eileen-collins", "skimage", "data/astronaut.png", (0.5, 0.33, 0.66), (54, 0, 340, 400)),
)
MOVING_PORTRAIT = ("grace-hopper", "happy")
"""The portrait that moves on arrival, and what it acts out."""
WALKING_FIGURE = ("woman-in-red", "walk")
"""The figure that moves on arrival, and its motion."""


def main() -> None:
    """Write all of it."""
    OUT_FOLDER.mkdir(parents=True, exist_ok=True)
    for sample in SAMPLE_PORTRAITS:
        picture = sample.picture()
        write_image(OUT_FOLDER / f"{sample.name}.jpg", picture, quality=JPEG_QUALITY)
        write_image(OUT_FOLDER / f"{sample.name}-small.jpg", small(picture, *sample.face), quality=JPEG_QUALITY)
    for name, picture in (("rendered-man", rendered_actor()), ("painted-man", painted_actor())):
        write_image(OUT_FOLDER / f"{name}.jpg", picture, quality=JPEG_QUALITY)
        write_image(OUT_FOLDER / f"{name}-small.jpg", small(picture, 0.5, 0.45, 0.85), quality=JPEG_QUALITY)
    for figure in SAMPLE_FIGURES:
        picture = paint_figure(figure)
        write_image(OUT_FOLDER / f"{figure.name}.jpg", picture, quality=JPEG_QUALITY)
        tiny = np.asarray(cv2.resize(picture, SMALL_FIGURE_SIZE_PIXELS, interpolation=cv2.INTER_AREA), np.uint8)
        write_image(OUT_FOLDER / f"{figure.name}-small.jpg", tiny, quality=JPEG_QUALITY)
    move(*MOVING_PORTRAIT)
    walk(*WALKING_FIGURE)


def small(picture: NDArray[np.uint8], x: float, y: float, height: float) -> NDArray[np.uint8]:
    """The square around (x, y) whose side is `height`, shares of the picture's width and height, in SMALL pixels."""
    tall, wide = picture.shape[:2]
    side = min(round(height * tall), wide)
    left = int(np.clip(round(x * wide - side / 2), 0, wide - side))
    top = int(np.clip(round(y * tall - side / 2), 0, tall - side))
    part = np.ascontiguousarray(picture[top : top + side, left : left + side])
    return np.asarray(cv2.resize(part, (THUMBNAIL_PIXELS, THUMBNAIL_PIXELS), interpolation=cv2.INTER_AREA), np.uint8)


def move(name: str, performance: str) -> None:
    """The clip of a portrait that acts something out, and its first frame: the portrait as it is."""
    with TemporaryDirectory() as folder:
        video = animate(
            OUT_FOLDER / f"{name}.jpg", performance, Path(folder), crop="bust", size=CLIP_SIZE, loop=True
        ).path
        shrink(video, OUT_FOLDER / f"{name}-{performance}.mp4")
    first = next(iter(read_video(OUT_FOLDER / f"{name}-{performance}.mp4")))
    write_image(OUT_FOLDER / f"{name}-still.jpg", first.rgb, quality=JPEG_QUALITY)


def walk(name: str, motion: str) -> None:
    """The clip of a figure that walks out of its picture, and its first frame: the picture as it is."""
    with TemporaryDirectory() as folder:
        video = wake_up(OUT_FOLDER / f"{name}.jpg", Path(folder), motion, size=FIGURE_CLIP_SIZE).artifacts[
            "animation.mp4"
        ]
        shrink(video, OUT_FOLDER / f"{name}-{motion}.mp4")
    first = next(iter(read_video(OUT_FOLDER / f"{name}-{motion}.mp4")))
    write_image(OUT_FOLDER / f"{name}-still.jpg", first.rgb, quality=JPEG_QUALITY)


def shrink(video: Path, out: Path) -> None:
    """The video again with fewer bytes: it is there to be looked at on the page alone."""
    found = probe_video(video)
    with VideoWriter(VideoTarget(out, (found.width, found.height), found.fps, crf=CLIP_CRF)) as writer:
        for frame in read_video(video):
            writer.write(frame.rgb)


if __name__ == "__main__":
    main()
