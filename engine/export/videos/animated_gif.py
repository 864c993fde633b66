"""Animated GIF: one palette for all frames, and a dither that stays where it is.

The palette is that of the first second or so (`SAMPLE` frames): the people and the picture stay the same. Bayer's ordered
dither hangs on a pixel's place alone, so that what does not move does not flicker, and costs nothing in the file; error
diffusion crawls from frame to frame. Source of both: FFmpeg's filters `palettegen` and `paletteuse`.

Measured on 60 frames of a made performance at 480x480: size, means over 8 x 8 pixels against the source in grey levels,
and deviation over time of what never changes. `bayer` has 3.2 MB, 0.66, 0.06; `sierra2_4a` 3.6 MB, 0.34, 0.06; no
dither 3.0 MB, 0.40, 0.05, and bands on skin.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from typing import cast

import av
import numpy as np
from av.filter import Graph
from av.video.format import VideoFormat
from av.video.frame import VideoFrame

from engine.export import synthetic
from engine.export.videos.encoders import VideoTarget

MAX_GIF_SIDE_PIXELS = 640
"""Pixels of the longer side where no size is asked for: files grow with the area, and hold no video's compression."""
PALETTE_FRAMES = 25
"""Frames of which the palette is made, at most."""
MAX_HELD_BYTES = 200_000_000
"""Bytes of frames that wait for it: of large ones there are fewer."""
_TICKS_PER_SECOND = 100
"""Of the format's clock, a second."""
_MIN_FRAME_TICKS = 2
"""Ticks; browsers show frames that claim less for a tenth of a second."""
_DITHER = "dither=bayer:bayer_scale=3:diff_mode=rectangle:alpha_threshold=128"


class GifEncoder:
    """Frames into an animated GIF, which repeats for ever; `transparent` ones keep what is more than half opaque."""

    def __init__(self, target: VideoTarget, transparent: bool):
        self._target, self._transparent = target, transparent
        self._waiting: list[VideoFrame] = []
        self._graph: Graph | None = None
        self._sample = min(PALETTE_FRAMES, max(1, MAX_HELD_BYTES // (4 * target.size[0] * target.size[1])))
        self._count, self._ended = 0, -_MIN_FRAME_TICKS
        last = (
            target.begins(len(target.times) - 1) - target.begins(len(target.times) - 2)
            if target.times
            else 1 / target.fps
        )
        options = {"loop": "0", "final_delay": str(max(_MIN_FRAME_TICKS, min(round(last * _TICKS_PER_SECOND), 65535)))}
        self._container = av.open(str(target.path), "w", format="gif", options=options)
        self._stream = self._container.add_stream("gif", rate=_TICKS_PER_SECOND)
        self._stream.width, self._stream.height = target.size
        self._stream.pix_fmt = "pal8"
        self._stream.codec_context.time_base = Fraction(1, _TICKS_PER_SECOND)

    @property
    def frames_held(self) -> int:
        """Frames that wait for the palette."""
        return len(self._waiting)

    def prepare(self, rgb: np.ndarray, alpha: np.ndarray | None) -> VideoFrame:
        """The frame in RGBA."""
        opaque = np.full(rgb.shape[:2], 255, np.uint8)
        own = opaque if alpha is None or not self._transparent else np.round(alpha * 255).astype(np.uint8)
        return VideoFrame.from_ndarray(np.dstack([rgb, own]), "rgba")

    def add(self, prepared: VideoFrame) -> None:
        """Code a frame, or keep it until there are enough for a palette. Frames too short to be shown are left out."""
        at = round(self._target.begins(self._count) * _TICKS_PER_SECOND)
        self._count += 1
        if at < self._ended + _MIN_FRAME_TICKS:
            return
        self._ended = at
        prepared.pts, prepared.time_base = at, Fraction(1, _TICKS_PER_SECOND)
        self._waiting.append(prepared)
        if self._graph is not None or len(self._waiting) >= self._sample:
            self._code()

    def finish(self) -> None:
        """Complete the file and close it."""
        self._code()
        self._sources[0].push(None)
        self._take()
        self._container.mux(self._stream.encode(None))
        self._container.close()
        if self._target.synthetic:
            synthetic.append_to_gif(self._target.path)

    def abandon(self) -> None:
        """Close the file, whatever state it is in."""
        with suppress(av.FFmpegError, OSError, ValueError):
            self._container.close()

    def _code(self) -> None:
        if self._graph is None:
            self._graph = self._dithering(_palette(self._waiting, self._transparent))
        for frame in self._waiting:
            self._sources[0].push(frame)
            self._take()
        self._waiting = []

    def _take(self) -> None:
        """Code what comes out of the graph."""
        with suppress(av.error.BlockingIOError, av.error.EOFError):
            while True:
                frame = cast(VideoFrame, self._sink.pull())
                self._container.mux(self._stream.encode(frame))

    def _dithering(self, palette: VideoFrame) -> Graph:
        graph = Graph()
        clock = Fraction(1, _TICKS_PER_SECOND)
        width, height = self._target.size
        pictures = graph.add_buffer(width=width, height=height, format=VideoFormat("rgba"), time_base=clock)
        colours = graph.add_buffer(width=16, height=16, format=palette.format, time_base=clock)
        use, self._sink = graph.add("paletteuse", _DITHER), graph.add("buffersink")
        pictures.link_to(use, 0, 0)
        colours.link_to(use, 0, 1)
        use.link_to(self._sink)
        graph.configure()
        self._sources = pictures, colours
        palette.pts, palette.time_base = 0, clock
        colours.push(palette)
        colours.push(None)
        return graph


def _palette(frames: list[VideoFrame], transparent: bool) -> VideoFrame:
    """The colours (16 x 16) that stand for those of all frames."""
    graph = Graph()
    first = frames[0]
    source = graph.add_buffer(
        width=first.width, height=first.height, format=VideoFormat("rgba"), time_base=Fraction(1, _TICKS_PER_SECOND)
    )
    generate, sink = graph.add("palettegen", f"reserve_transparent={int(transparent)}"), graph.add("buffersink")
    source.link_to(generate)
    generate.link_to(sink)
    graph.configure()
    for frame in [*frames, None]:
        source.push(frame)
    return cast(VideoFrame, sink.pull())
