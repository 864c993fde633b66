"""Videos out: H.264, VP9, animated WebP or numbered PNGs, written frame by frame and published whole."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from dataclasses import replace
from types import TracebackType
from typing import Any, Self

import numpy as np

from engine.export.videos.animated_gif import GifEncoder
from engine.export.videos.animated_webp import WebpEncoder
from engine.export.videos.encoders import Encoder, PngEncoder, StreamEncoder, VideoTarget

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
    target : the video that is to be written.
    warn : called with (code, message): `no_sound` where there is none to carry, or the format holds none; `sound_damaged`
        where parts of it cannot be read.

    Raises `ValueError` for frames that do not fit and for a video of none, `OSError` where the disk is full.
    """

    def __init__(self, target: VideoTarget, warn: Warn | None = None):
        self._target = target
        self._draft = target.path.with_name(f".{target.path.name}.draft")
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
