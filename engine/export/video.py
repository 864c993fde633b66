"""Videos out: H.264, VP9, animated WebP or numbered PNGs, written frame by frame and published whole."""

from __future__ import annotations

import zipfile
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

import av
import cv2
import numpy as np
from av.video.reformatter import Colorspace, Interpolation, VideoReformatter

from engine.media.timing import exact_rate

Format = Literal["mp4", "webm", "webp", "png"]
_CODECS = {"mp4": "libx264", "webm": "libvpx-vp9", "webp": "libwebp_anim"}


def even_size(width: float, height: float) -> tuple[int, int]:
    """The nearest even width and height (at least 2), as 4:2:0 video wants them."""
    return max(2, 2 * round(width / 2)), max(2, 2 * round(height / 2))


class VideoWriter:
    """Writes a video of `size` (w, h) at `fps`; a context manager.

    The file appears under `path` only when the block ends without an error.
    """

    def __init__(
        self,
        path: Path,
        size: tuple[int, int],
        fps: float,
        format: Format = "mp4",
        crf: int | None = None,
        sound: Path | None = None,
        sound_trim: tuple[float, float] | None = None,
        loop: bool = False,
    ):
        self.path = path
        self._draft = path.with_name(f".{path.name}.draft")
        self._size = size
        self._format = format
        self._count = 0
        self._reformatter = VideoReformatter()
        if format == "png":
            self._zip = zipfile.ZipFile(self._draft, "w")
            return
        if format != "webp" and (size[0] % 2 or size[1] % 2):
            raise ValueError(f"the size of a video must be even, not {size}")
        options = {"mp4": {"movflags": "+faststart"}, "webp": {"loop": "0" if loop else "1"}}.get(format, {})
        self._container = av.open(str(self._draft), "w", format=format, options=options)
        self._stream = self._container.add_stream(_CODECS[format], rate=exact_rate(fps))
        self._stream.width, self._stream.height = size
        context = self._stream.codec_context
        if format == "mp4":
            self._stream.pix_fmt = "yuv420p"
            self._stream.options = {"preset": "veryfast", "crf": str(crf or 20), "profile": "high"}
        elif format == "webm":
            self._stream.pix_fmt = "yuv420p"
            self._stream.options = {"deadline": "realtime", "cpu-used": "6", "crf": str(crf or 30), "b": "0"}
        else:
            self._stream.pix_fmt = "bgra"
        if format != "webp":
            context.color_primaries = context.color_trc = context.colorspace = 1
            context.color_range = 1
        context.thread_count = 2

    def __enter__(self) -> Self:
        return self

    def write(self, rgb: np.ndarray, alpha: np.ndarray | None = None) -> None:
        """Add a frame: `rgb` uint8 (H, W, 3), `alpha` float32 (H, W) [0, 1] where the format keeps it."""
        if self._format == "png":
            image = cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR)
            if alpha is not None:
                image = np.dstack([image, np.round(alpha * 255).astype(np.uint8)])
            self._zip.writestr(f"{self._count:06d}.png", cv2.imencode(".png", image)[1].tobytes())
            self._count += 1
            return
        frame = av.VideoFrame.from_ndarray(rgb, "rgb24")
        frame.pts = self._count
        self._count += 1
        if self._format == "webp":
            frame = frame.reformat(format="bgra")
        else:
            frame = self._reformatter.reformat(
                frame, format="yuv420p", dst_colorspace=Colorspace.ITU709, interpolation=Interpolation.BILINEAR
            )
        for packet in self._stream.encode(frame):
            self._container.mux(packet)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if self._format == "png":
                self._zip.close()
            else:
                if kind is None:
                    for packet in self._stream.encode(None):
                        self._container.mux(packet)
                self._container.close()
            if kind is None:
                self._draft.replace(self.path)
        finally:
            self._draft.unlink(missing_ok=True)
