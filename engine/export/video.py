"""Videos out: H.264, VP9, animated WebP or numbered PNGs, written frame by frame and published whole."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from engine.export.animated_gif import GifEncoder
from engine.export.animated_webp import WebpEncoder
from engine.export.encoders import Encoder, Format, PngEncoder, StreamEncoder, Target

Warn = Callable[[str, str], None]

_MAX_WAITING_FRAMES = 4
"""Frames that may wait for the encoder: enough to even out its pace, few enough that memory stays flat."""


class VideoWriter:
    """Writes a video; a context manager. The file appears under its name when the block ends without an error, and
    not at all otherwise.

    Encoding runs in a thread of its own: `write` converts the frame (its arrays may be changed right after) and waits
    only when the encoder is frames behind.

    Parameters
    ----------
    path : where the video is to be.
    size : (width, height) in pixels of every frame; even for "mp4" and "webm".
    fps : frames a second.
    format : "mp4" (H.264, 4:2:0, faststart), "webm" (VP9), "webp" (animated), "gif" (which repeats) or "png" (a zip
        archive of PNGs). All but "mp4" keep alpha where the first frame has it; the first two are BT.709, limited range,
        and tagged so.
    crf : constant rate factor of H.264 and VP9: lower is better and larger; the other formats have none.
    sound : a video file whose sound is carried over ("mp4", "webm"): copied where it fits, else coded anew.
    sound_trim : (start, end) seconds of that file's video that the frames stand for.
    loop : whether the video is to be played again and again: the end is coded for leading into the beginning, and an
        animated WebP repeats for ever (of the others, the player decides).
    frames : how many there will be, where that is known; an "mp4" that loops needs it.
    times : seconds at which each frame comes on show, and the last one ends; by default evenly, by `fps`.
    entries : "mp4" alone: the frames, counted from 0, at which a player can begin. It is coded for going over to it from
        other videos of the same picture without a jump in its grain; between the entries it is slow to search.
    synthetic : whether the file says of itself that it is synthetic (`engine.export.synthetic`); no pixel changes.
    warn : called with (code, message): `no_sound` where there is none to carry, or the format holds none; `sound_damaged`
        where parts of it cannot be read.

    Raises `ValueError` for frames that do not fit and for a video of none, `OSError` where the disk is full.
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
        frames: int | None = None,
        times: Iterable[float] | None = None,
        entries: Iterable[int] | None = None,
        synthetic: bool = True,
        warn: Warn | None = None,
    ):
        if format in ("mp4", "webm") and (size[0] % 2 or size[1] % 2):
            raise ValueError(f"the size of a video must be even, not {size}")
        if entries is not None and format != "mp4":
            raise ValueError("only an MP4 has entries")
        whole = None if entries is None else frozenset(entries)
        at = None if times is None else tuple(float(time) for time in times)
        self._target = Target(path, size, fps, format, crf, sound, sound_trim, loop, frames, at, whole, synthetic)
        self._draft = path.with_name(f".{path.name}.draft")
        self._warn = warn or (lambda code, message: None)
        self._encoder: Encoder | None = None
        self._waiting: queue.Queue[Any] = queue.Queue(_MAX_WAITING_FRAMES)
        self._thread = threading.Thread(target=self._encode, name="video-encoder", daemon=True)
        self._failure: BaseException | None = None

    def __enter__(self) -> Self:
        return self

    def write(self, rgb: np.ndarray, alpha: np.ndarray | None = None) -> None:
        """Add a frame: `rgb` uint8 (H, W, 3), `alpha` float32 (H, W) [0, 1]. Raises what the encoder met meanwhile."""
        width, height = self._target.size
        if rgb.shape != (height, width, 3) or (alpha is not None and alpha.shape != (height, width)):
            raise ValueError(f"a frame of shape {rgb.shape} in a video of {width} x {height}")
        if alpha is not None and self._target.format == "mp4":
            raise ValueError("MP4 keeps no alpha: lay the frames over a background first")
        if self._encoder is None:
            self._encoder = self._start(transparent=alpha is not None)
        self._waiting.put(self._encoder.prepare(rgb, alpha))
        if self._failure is not None:
            raise self._failure

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if self._encoder is None:
                if error is None:
                    raise ValueError("a video of no frames")
                return
            self._waiting.put(None)
            self._thread.join()
            try:
                if error is None and self._failure is None:
                    self._encoder.finish()
                    self._tell_of_sound(self._encoder)
                    self._draft.replace(self._target.path)
            finally:
                self._encoder.abandon()
            if error is None and self._failure is not None:
                raise self._failure
        finally:
            self._draft.unlink(missing_ok=True)

    def _tell_of_sound(self, encoder: Encoder) -> None:
        sound = encoder.sound if isinstance(encoder, StreamEncoder) else None
        if sound is not None and sound.damaged:
            self._warn("sound_damaged", "Parts of the driver's sound cannot be read: they are left out.")

    def _start(self, transparent: bool) -> Encoder:
        target = replace(self._target, path=self._draft)
        encoder: Encoder
        if target.format == "png":
            encoder, has_sound = PngEncoder(target), False
        elif target.format == "gif":
            encoder, has_sound = GifEncoder(target, transparent), False
        elif target.format == "webp":
            encoder, has_sound = WebpEncoder(target, transparent), False
        else:
            encoder = stream = StreamEncoder(target, transparent)
            has_sound = stream.sound is not None
        if target.sound is not None and not has_sound:
            self._warn("no_sound", "The result has no sound: the driver has none, or the format holds none.")
        self._thread.start()
        return encoder

    def _encode(self) -> None:
        """The thread: code what waits until None comes; after a failure, only empty the queue."""
        while (prepared := self._waiting.get()) is not None:
            if self._failure is None and self._encoder is not None:
                try:
                    self._encoder.add(prepared)
                except BaseException as failure:
                    self._failure = failure
