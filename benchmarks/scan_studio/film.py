"""A film as a phone keeps it: held upright, stored lying, with a note of how to turn it; H.264 or HEVC."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Literal, cast

import av
import numpy as np
from av.video.stream import VideoStream
from numpy.typing import NDArray

from engine.media.ycbcr import BT709, LIMITED_RANGE, frame_from_rgb

Codec = Literal["h264", "hevc"]
FRAMES_PER_SECOND = 30
"""As the file has them; they are spread over all of the capture."""
TURN_DEGREES = 90
"""By which a player has to turn what is stored, as FFmpeg counts: against the clock."""
ENCODERS: dict[Codec, tuple[str, dict[str, str]]] = {
    "h264": ("libx264", {"preset": "veryfast", "crf": "21"}),
    "hevc": ("libx265", {"preset": "superfast", "crf": "23", "tag": "hvc1", "x265-params": "log-level=error"}),
}
"""Quality as phones have it. They are studio films of few frames, of which each shows more that is new than a phone's does, so
that a phone's bits a second would be too few for them."""


def write_film(path: Path, frames: Iterable[NDArray[np.uint8]], size: tuple[int, int], codec: Codec) -> None:
    """Code upright frames (H, W, 3) of a `size` (width, height), both even."""
    encoder, options = ENCODERS[codec]
    with av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"}) as container:
        stream = cast(VideoStream, container.add_stream(encoder, rate=FRAMES_PER_SECOND, options=options))
        stream.height, stream.width = size
        stream.pix_fmt = "yuv420p"
        stream.set_display_rotation(TURN_DEGREES)
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709
        context.color_range = LIMITED_RANGE
        for number, upright in enumerate(frames):
            frame = frame_from_rgb(np.ascontiguousarray(np.rot90(upright, -TURN_DEGREES // 90)))
            frame.pts, frame.time_base = number, Fraction(1, FRAMES_PER_SECOND)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
