"""A film as a phone keeps it: held upright, stored lying, with a note of how to turn it; H.264 or HEVC, or HEVC of high dynamic
range."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Literal, cast

import av
import numpy as np
from av.video.frame import VideoFrame
from av.video.stream import VideoStream
from numpy.typing import NDArray

from benchmarks.scan_studio.camera.developing import HLG_TRANSFER, hlg_frame, srgb_frame
from engine.media.colour_conversion.ycbcr import BT709, BT2020, LIMITED_RANGE

FilmFormat = Literal["h264", "hevc", "hlg"]
FRAMES_PER_SECOND = 30
"""Of the film's file; frames are spread over all of the capture."""
STORED_TURN_DEGREES = 90
"""By which a player has to turn what is stored, as FFmpeg counts: against the clock."""


@dataclass(frozen=True)
class Coding:
    """How a format is coded."""

    encoder: str
    """FFmpeg's name."""
    layout: str
    """Of the planes of a frame, by FFmpeg's name."""
    develop: Callable[[NDArray[np.float32]], VideoFrame]
    """A frame of linear light (H, W, 3)."""
    options: dict[str, str]
    """Of the encoder."""
    primaries: int = BT709
    """FFmpeg's number of the primaries, and of the matrix."""
    transfer: int = BT709
    """FFmpeg's number of the transfer curve."""
    tag: str | None = None
    """By which MP4 names the codec, where it is not the usual one."""


_X264 = {"preset": "veryfast", "crf": "21"}
_X265 = {"preset": "superfast", "crf": "20", "x265-params": "log-level=error"}
NAMED_CODINGS: dict[FilmFormat, Coding] = {
    "h264": Coding("libx264", "yuv420p", srgb_frame, _X264),
    "hevc": Coding("libx265", "yuv420p", srgb_frame, _X265, tag="hvc1"),
    "hlg": Coding("libx265", "yuv420p10le", hlg_frame, _X265, BT2020, HLG_TRANSFER, tag="hvc1"),
}
"""Quality as phones have it. A studio film has few frames, of which each shows more that is new than a phone's does: a phone's
bits a second would be too few for them."""


def write_film(
    path: Path, frames: Iterable[NDArray[np.float32]], size: tuple[int, int], film_format: FilmFormat
) -> None:
    """Code upright frames (H, W, 3), linear light whose white is 1, of a `size` (width, height), both even."""
    coding = NAMED_CODINGS[film_format]
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"}) as container:
        stream = cast(VideoStream, container.add_stream(coding.encoder, rate=FRAMES_PER_SECOND, options=coding.options))
        stream.height, stream.width = size
        stream.pix_fmt = coding.layout
        stream.set_display_rotation(STORED_TURN_DEGREES)
        context = stream.codec_context
        if coding.tag is not None:
            context.codec_tag = coding.tag
        context.colorspace = context.color_primaries = coding.primaries
        context.color_trc, context.color_range = coding.transfer, LIMITED_RANGE
        for number, upright in enumerate(frames):
            frame = coding.develop(np.ascontiguousarray(np.rot90(upright, -STORED_TURN_DEGREES // 90)))
            frame.pts, frame.time_base = number, Fraction(1, FRAMES_PER_SECOND)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
