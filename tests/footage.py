"""Clips made for the tests: known pixels, known timestamps, written by FFmpeg's encoders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path

import av
import numpy as np

TICKS = 1000  # of the clock that test clips are written with, a second


def quadrants(width: int, height: int) -> np.ndarray:
    """Red, green, blue and white quarters (top left, top right, bottom left, bottom right), uint8 RGB."""
    image = np.full((height, width, 3), 255, np.uint8)
    image[: height // 2, : width // 2] = (220, 30, 30)
    image[: height // 2, width // 2 :] = (30, 180, 30)
    image[height // 2 :, : width // 2] = (30, 30, 220)
    return image


def counter(k: int, width: int = 64, height: int = 48) -> np.ndarray:
    """Frame number `k` (0 to 255) as an image: eight vertical bars, black or white, are its binary digits."""
    bits = [(k >> i) & 1 for i in range(8)]
    row = np.repeat(np.array(bits, np.uint8) * 225 + 15, -(-width // 8))[:width]
    return np.broadcast_to(row[None, :, None], (height, width, 3)).copy()


def number(rgb: np.ndarray) -> int:
    """The frame number that `counter` drew."""
    width = rgb.shape[1]
    middles = ((np.arange(8) + 0.5) * -(-width // 8)).astype(int)
    return int(sum(1 << i for i in range(8) if rgb[rgb.shape[0] // 2, middles[i]].mean() > 128))


def write_clip(
    path: Path,
    pictures: Sequence[np.ndarray],
    fps: float = 25,
    times: Sequence[float] | None = None,
    codec: str = "libx264",
    layout: str = "yuv420p",
    options: dict[str, str] | None = None,
    container_options: dict[str, str] | None = None,
    dress: Callable[[av.VideoStream], None] | None = None,
    convert: Callable[[np.ndarray], av.VideoFrame] | None = None,
    format: str | None = None,
) -> Path:
    """Write `pictures` (uint8 RGB) as the frames of a clip, at `fps` or at `times` (seconds).

    `dress` may set tags of the stream; `convert` makes the video frame of a picture where swscale's way will not do.
    """
    with av.open(str(path), "w", format=format, options=container_options or {}) as container:
        stream = container.add_stream(codec, rate=Fraction(fps).limit_denominator(1001))
        stream.height, stream.width = pictures[0].shape[:2]
        stream.pix_fmt = layout
        stream.options = options if options is not None else {"crf": "10"} if codec.startswith("libx26") else {}
        if times is not None:
            stream.codec_context.time_base = Fraction(1, TICKS)
        if dress is not None:
            dress(stream)
        for k, picture in enumerate(pictures):
            if convert is not None:
                frame = convert(picture)
            else:
                frame = av.VideoFrame.from_ndarray(picture, "rgb24").reformat(format=layout)
            if times is not None:
                frame.pts, frame.time_base = round(times[k] * TICKS), Fraction(1, TICKS)
            else:
                frame.pts, frame.time_base = k, 1 / Fraction(fps).limit_denominator(1001)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path
