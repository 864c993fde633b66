"""How each format is coded and laid into its file.

Measured on 100 frames of a talking man at 600x800 on one core, with the PSNR of brightness. x264 `ultrafast` crf 18
takes 4 ms a frame and 1430 kB (47.4 dB), `superfast` crf 20 6 ms and 640 kB (46.1). `veryfast` crf 18 takes 9 ms and
370 kB (45.4), `medium` crf 20 34 ms and 350 kB (45.7). `superfast` crf 17 with a macroblock tree over 10 frames, which
is used, takes 6 ms and 520 kB (46.1): nothing is to be seen in the picture, and the renderer keeps the processor.
"""

from __future__ import annotations

import zipfile
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal, Protocol, cast

import av
import cv2
import numpy as np
from av.video.frame import PictureType, VideoFrame
from av.video.stream import VideoStream

from engine.export import synthetic
from engine.export.videos.sound import SoundTrack, open_sound
from engine.media.colour_conversion.ycbcr import BT709, LIMITED_RANGE, frame_from_rgb
from engine.media.decoding.timing import exact_rate

_TICKS_PER_SECOND = 90_000
"""Ticks a second of frames that are not shown equally long, as is usual for video."""

Format = Literal["mp4", "webm", "webp", "gif", "png"]


@dataclass(frozen=True)
class VideoTarget:
    """A video that is to be written. Raises `ValueError` where its fields do not fit each other."""

    path: Path
    """Where it is to be."""
    size: tuple[int, int]
    """(width, height) in pixels of every frame; even for "mp4" and "webm"."""
    fps: float
    """Frames a second."""
    format: Format = "mp4"
    """`mp4` (H.264, 4:2:0, faststart), `webm` (VP9), `webp` (animated), `gif` (which repeats) or `png` (a zip archive of
    PNGs). All but `mp4` keep alpha where the first frame has it; the first two are BT.709, limited range, and tagged so."""
    crf: int | None = None
    """Constant rate factor of H.264 and VP9: lower is better and larger; the other formats have none."""
    sound: Path | None = None
    """A video file whose sound is carried over ("mp4", "webm"): copied where it fits, else coded anew."""
    sound_trim: tuple[float, float] | None = None
    """(start, end) seconds of that file's video that the frames stand for."""
    loop: bool = False
    """Whether the video is to be played again and again: the end is coded for leading into the beginning, and an animated
    WebP repeats for ever (of the others, the player decides)."""
    frames: int | None = None
    """How many there will be, where that is known; an "mp4" that loops needs it."""
    times: Sequence[float] | None = None
    """Seconds at which each frame comes on show, and the last one ends; by default evenly, by `fps`."""
    entries: Collection[int] | None = None
    """MP4 alone: the frames, counted from 0, at which a player can begin. It is coded for going over to it from other
    videos of the same picture without a jump in its grain; between the entries it is slow to search."""
    synthetic: bool = True
    """Whether the file says of itself that it is synthetic (`engine.export.synthetic`); no pixel changes."""

    def __post_init__(self) -> None:
        if self.format in ("mp4", "webm") and (self.size[0] % 2 or self.size[1] % 2):
            raise ValueError(f"the size of a video must be even, not {self.size}")
        if self.entries is not None and self.format != "mp4":
            raise ValueError("only an MP4 has entries")

    def begins(self, frame: int) -> float:
        """Seconds at which a frame comes on show, or the one before the first that there is not ends."""
        if self.times is None:
            return float(frame / exact_rate(self.fps))
        return float(self.times[min(frame, len(self.times) - 1)])


class Encoder(Protocol):
    """Frames into a file. `prepare` may run beside `add`; the others one after another."""

    def prepare(self, rgb: np.ndarray, alpha: np.ndarray | None) -> Any:
        """What `add` takes, holding nothing of the arrays given: uint8 (H, W, 3) and float32 (H, W) or None."""

    def add(self, prepared: Any) -> None:
        """Code a frame."""

    def finish(self) -> None:
        """Complete the file and close it."""

    def abandon(self) -> None:
        """Close the file, whatever state it is in."""


@dataclass(frozen=True)
class _Coding:
    codec: str
    options: dict[str, str]
    container: dict[str, str]
    threads: int


_CODINGS = {
    "mp4": _Coding(
        "libx264",
        {"crf": "17", "preset": "superfast", "profile": "high", "x264-params": "mbtree=1:rc-lookahead=10"},
        {"movflags": "+faststart"},
        threads=1,  # the writer's own thread; x264's frame threads cost a third more processor time
    ),
    "webm": _Coding(
        "libvpx-vp9",
        {"crf": "24", "b": "0", "deadline": "realtime", "cpu-used": "7", "row-mt": "1", "auto-alt-ref": "0"},
        {},
        threads=2,
    ),
}


ENTRIES_OPTIONS = {
    "crf": "20",
    "preset": "veryfast",
    "forced-idr": "1",
    # No frame is coded out of order: the first after a jump is shown without waiting for others.
    "x264-params": "keyint=infinite:scenecut=0:bframes=0:mbtree=0:qcomp=1:ipratio=1:aq-mode=0",
}
"""H.264 for a video with entries. Whole pictures and what changes, flat and textured parts are all coded equally fine.
The grain of one video goes on in the next, and no frame is sharper than the one before. At a jump to a frame that shows
nearly the same (0.95 grey levels in the mean) 0.98 were seen, with the usual settings 1.8."""


_SEAM_QUANTISER = 6
"""Quantiser of the first frame of an H.264 video that loops, and of its last."""
_SEAM_FRAMES = 12
"""Frames at the end of a video that loops over which the quantiser goes down to `_SEAM_QUANTISER`."""
_SEAM_START = 20

_LOOPED_WEBM = {"crf": "14", "cpu-used": "4"}
"""What coding takes from a frame differs from the first to the last: videos that repeat are coded more finely.

Measured on a portrait at 474x474 that idles for 150 frames and comes to rest where it began (the mean difference between
the last frame and the first: 0.01 grey levels; largest step 1.85, median 0.39), decoded again:

| coding | seam | largest step | median | kB | ms a frame |
| --- | --- | --- | --- | --- | --- |
| mp4 as usual | 1.07 | 1.68 | 0.41 | 237 | 2 |
| mp4, crf 12, all frames alike (as `ENTRIES_OPTIONS`) | 0.70 | 1.91 | 0.45 | 1014 | 2 |
| mp4, quantiser down to 10 over the last 10 frames | 0.54 | 1.66 | 0.40 | 309 | 2 |
| mp4, down to 6 over the last 12, which is used | 0.37 | 1.69 | 0.40 | 356 | 2 |
| mp4, down to 4 over the last 18 | 0.27 | 1.68 | 0.40 | 427 | 2 |
| webm as usual | 0.87 | 1.92 | 0.45 | 215 | 3 |
| webm, crf 10 | 0.68 | 1.95 | 0.53 | 637 | 3 |
| webm, crf 14, `cpu-used` 4, which is used | 0.67 | 1.90 | 0.50 | 301 | 7 |
| webm, crf 14, deadline `good` | 0.59 | 1.86 | 0.45 | 226 | 18 |

libvpx takes no quantiser for single frames.
"""


def _looped(target: VideoTarget, usual: dict[str, str]) -> dict[str, str]:
    """Options of a video that loops, in place of the `usual` ones."""
    if target.format == "webm":
        return _LOOPED_WEBM
    if target.frames is None:
        return {}
    ending = min(_SEAM_FRAMES, target.frames // 2)
    fall = np.linspace(_SEAM_START, _SEAM_QUANTISER, ending + 1)[1:].round().astype(int)
    places = [0, *range(target.frames - ending, target.frames)]
    zones = "/".join(f"{k},{k},q={q}" for k, q in zip(places, [_SEAM_QUANTISER, *fall], strict=True))
    return {"x264-params": f"{usual['x264-params']}:zones={zones}"}


class StreamEncoder:
    """MP4 (H.264) and WebM (VP9), by FFmpeg."""

    def __init__(self, target: VideoTarget, transparent: bool):
        coding = _CODINGS[target.format]
        self._target = target
        self._transparent = transparent
        self._rate = exact_rate(target.fps)
        self._entries = target.entries or frozenset()
        self._count = 0
        self._lengths: dict[int, int] = {}
        self._container = av.open(str(target.path), "w", format=target.format, options=coding.container)
        if target.synthetic:
            self._container.metadata.update(synthetic.VIDEO_TAGS)
        self._stream = cast(VideoStream, self._container.add_stream(coding.codec, rate=self._rate))
        self._stream.width, self._stream.height = target.size
        if target.times is not None:
            self._stream.codec_context.time_base = Fraction(1, _TICKS_PER_SECOND)
        crf = {} if target.crf is None else {"crf": str(target.crf)}
        special = ENTRIES_OPTIONS if target.entries else _looped(target, coding.options) if target.loop else {}
        self._stream.options = {**coding.options, **special, **crf}
        self._stream.codec_context.thread_count = coding.threads
        self._stream.pix_fmt = "yuva420p" if transparent else "yuv420p"
        context = self._stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709
        context.color_range = LIMITED_RANGE
        self.sound: SoundTrack | None = None
        if target.sound is not None:
            self.sound = open_sound(target.sound, self._container, target.format, target.sound_trim)

    def prepare(self, rgb: np.ndarray, alpha: np.ndarray | None) -> VideoFrame:
        """The frame as the codec takes it."""
        if self._transparent and alpha is None:
            alpha = np.ones(rgb.shape[:2], np.float32)
        return frame_from_rgb(rgb, alpha if self._transparent else None)

    def add(self, prepared: VideoFrame) -> None:
        """Code a frame, and the sound up to it."""
        if self._target.times is None:
            prepared.pts, prepared.time_base = self._count, 1 / self._rate
        else:
            begins, ends = (round(self._target.begins(k) * _TICKS_PER_SECOND) for k in (self._count, self._count + 1))
            prepared.pts, prepared.time_base = begins, Fraction(1, _TICKS_PER_SECOND)
            self._lengths[begins] = ends - begins
        if self._count in self._entries:
            prepared.pict_type = PictureType.I
        self._count += 1
        self._mux(self._stream.encode(prepared))
        if self.sound is not None:
            self.sound.mux_until(self._target.begins(self._count))

    def _mux(self, packets: list[av.Packet]) -> None:
        """Lay packets in, with the lengths of their frames: x264 does not hand them on."""
        for packet in packets:
            if packet.pts in self._lengths:
                packet.duration = self._lengths.pop(packet.pts)
        self._container.mux(packets)

    def finish(self) -> None:
        """Complete the file and close it."""
        self._mux(self._stream.encode(None))
        self._container.close()
        self._close_sound()
        if self._target.synthetic and self._target.format == "mp4":
            synthetic.append_to_mp4(self._target.path)

    def abandon(self) -> None:
        """Close the file, whatever state it is in."""
        with suppress(av.FFmpegError, OSError, ValueError):
            self._container.close()
        self._close_sound()

    def _close_sound(self) -> None:
        if self.sound is not None:
            self.sound.close()


class PngEncoder:
    """Numbered PNGs (`000000.png`, ...) in a zip archive, whose comment tells the rate. Where they are not shown
    equally long, `timecodes.txt` tells when each comes on show, in milliseconds (the format v2 that MKVToolNix
    reads)."""

    def __init__(self, target: VideoTarget):
        self._synthetic, self._target = target.synthetic, target
        self._archive = zipfile.ZipFile(target.path, "w", zipfile.ZIP_STORED)
        self._archive.comment = f"{float(Fraction(exact_rate(target.fps))):g} frames per second".encode()
        self._count = 0

    def prepare(self, rgb: np.ndarray, alpha: np.ndarray | None) -> np.ndarray:
        """The pixels in OpenCV's order."""
        return cv2.cvtColor(rgb, cv2.COLOR_RGB2BGR) if alpha is None else _bgra(rgb, alpha)

    def add(self, prepared: np.ndarray) -> None:
        """Code a picture."""
        png = cv2.imencode(".png", prepared)[1].tobytes()
        self._archive.writestr(f"{self._count:06d}.png", synthetic.marked_png(png) if self._synthetic else png)
        self._count += 1

    def finish(self) -> None:
        """Complete the archive and close it."""
        if self._target.times is not None:
            times = (f"{1000 * self._target.begins(k):.3f}\n" for k in range(self._count))
            self._archive.writestr("timecodes.txt", "".join(["# timecode format v2\n", *times]))
        self._archive.close()

    def abandon(self) -> None:
        """Close the archive."""
        with suppress(OSError, ValueError):
            self._archive.close()


def _bgra(rgb: np.ndarray, alpha: np.ndarray | None) -> np.ndarray:
    pixels = cv2.cvtColor(rgb, cv2.COLOR_RGB2BGRA)
    if alpha is not None:
        pixels[..., 3] = np.round(alpha * np.float32(255))
    return pixels
