"""Animated WebP, which FFmpeg's decoder does not read: its chunks give the timetable, Pillow the frames."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
from av.video.frame import VideoFrame
from PIL import Image

from engine.media.decoding.demux import Header, Timetable, unreadable

_MIN_FRAME_SECONDS = 0.011  # seconds; browsers show frames that claim less for a tenth of a second
_USUAL_FRAME_SECONDS = 0.1


def read_chunks(path: Path) -> tuple[Header, Timetable]:
    """The header and timetable of an animated WebP, with nothing decoded. Raises `video_unreadable`.

    Source: the WebP container specification (RIFF chunks `VP8X`, `ANMF`).
    """
    size: tuple[int, int] | None = None
    lengths: list[float] = []
    with path.open("rb") as file:
        total = int.from_bytes(file.read(8)[4:], "little") + 8
        file.seek(12)
        while len(head := file.read(8)) == 8:
            length = int.from_bytes(head[4:], "little")
            body = file.read(min(length, 16))
            if head[:4] == b"VP8X" and len(body) >= 10:
                size = 1 + int.from_bytes(body[4:7], "little"), 1 + int.from_bytes(body[7:10], "little")
            elif head[:4] == b"ANMF" and len(body) == 16:
                seconds = int.from_bytes(body[12:15], "little") / 1000
                lengths.append(seconds if seconds >= _MIN_FRAME_SECONDS else _USUAL_FRAME_SECONDS)
            file.seek(length - len(body) + length % 2, 1)
        cut = file.seek(0, 2) < total
    if size is None or not lengths:
        raise unreadable()
    times = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    header = Header(*size, fps=0.0, seconds=sum(lengths), frames=len(lengths), codec="webp")
    return header, Timetable(times, lengths[-1], cut)


def decode(path: Path, timetable: Timetable) -> Iterator[tuple[float, VideoFrame]]:
    """(seconds, frame in RGBA), until the end or the first frame that does not decode."""
    with suppress(OSError, EOFError, ValueError, SyntaxError), Image.open(path, formats=["WEBP"]) as image:
        for i, time in enumerate(timetable.times):
            image.seek(i)
            yield float(time), VideoFrame.from_ndarray(np.asarray(image.convert("RGBA")), "rgba")
