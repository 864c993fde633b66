"""A live portrait at work: one thread looks at the camera's newest frame while another draws what the last one showed.

Nothing waits in a queue: a frame that comes while another is looked at takes the place of the one before it.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from typing import Any

import cv2

from engine.export.synthetic import marked_jpeg
from engine.portrait.live.live_portrait import LivePortrait, Watched
from service.live.process import COMMAND_TAG, EVENT_TAG, FRAME_TAG
from worker.live.camera_frame import UnreadableFrame, read_frame
from worker.live.newest import Newest
from worker.live.wire import Wire

STREAM_JPEG_QUALITY = 85


class LiveStream:
    """Feeds a portrait with what comes over a wire, and sends what it does."""

    def __init__(self, wire: Wire, portrait: LivePortrait, frame_pixels: int, mark: bool):
        self._wire, self._portrait, self._pixels, self._mark = wire, portrait, frame_pixels, mark
        self._frames: Newest[tuple[float, bytes]] = Newest()
        self._drawn: Newest[tuple[bytes, Watched]] = Newest()
        self._again = threading.Event()
        self._told: dict[str, Any] = {}
        self._failed: dict[str, str] | None = None

    def run(self) -> None:
        """Until the other side has gone, or a frame cannot be read."""
        threads = [self._thread(self._look), self._thread(self._draw)]
        while (message := self._wire.receive()) is not None:
            kind, data = message
            if kind == FRAME_TAG:
                self._frames.put((time.monotonic(), data))
            elif kind == COMMAND_TAG:
                self._again.set()
        self._frames.close()
        self._drawn.close()
        for thread in threads:
            thread.join()

    def _thread(self, work: Callable[[], None]) -> threading.Thread:
        def worked() -> None:
            try:
                work()
            except OSError:
                pass  # the other side has gone
            except UnreadableFrame:
                self._fail("live_frame_unreadable")

        thread = threading.Thread(target=worked, daemon=True)
        thread.start()
        return thread

    def _fail(self, code: str) -> None:
        self._wire.send(EVENT_TAG, json.dumps({"event": "failed", "code": code, "detail": ""}).encode())

    def _look(self) -> None:
        while (frame := self._frames.take()) is not None:
            came, data = frame
            if self._again.is_set():
                self._again.clear()
                self._portrait.recalibrate()
            watched = self._portrait.watch(read_frame(data[4:], self._pixels), came)
            self._tell(watched)
            self._drawn.put((data[:4], watched))

    def _draw(self) -> None:
        while (drawn := self._drawn.take()) is not None:
            number, watched = drawn
            bgr = cv2.cvtColor(self._portrait.draw(watched), cv2.COLOR_RGB2BGR)
            done, jpeg = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, STREAM_JPEG_QUALITY])
            assert done
            data = jpeg.tobytes()
            self._wire.send(FRAME_TAG, number + (marked_jpeg(data) if self._mark else data))

    def _tell(self, watched: Watched) -> None:
        """Say what changed."""
        event: dict[str, Any] = {"event": {"live": "ready"}.get(watched.state, watched.state)}
        if watched.state == "calibrating":
            event |= {"fraction": round(watched.fraction, 1), "obstacle": watched.obstacle}
        if event != self._told:
            self._told = event
            self._wire.send(EVENT_TAG, json.dumps(event).encode())
