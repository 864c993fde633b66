"""One live portrait: a process, the camera that feeds it, and those who look. It ends by itself."""

from __future__ import annotations

import asyncio
import json
import time
from typing import Any

import structlog

from service.live.outlet import Outlet
from service.live.process import COMMAND_TAG, EVENT_TAG, FRAME_TAG, LiveOrder, LiveProcess, StartLive
from service.settings import BYTES_PER_MEGABYTE, Settings

CAMERA_WAIT_SECONDS = 60.0
"""How long a session waits for its camera."""
SESSION_POLL_SECONDS = 0.5
"""How often is looked whether it is to end."""

END_REASONS = {
    "live_idle": "No frame of the camera came for a while, or nobody looked: begin anew.",
    "live_time_limit": "The live portrait lasted as long as one may: begin anew.",
    "live_closed": "The camera's connection was closed.",
    "live_ended": "The live portrait was ended.",
    "live_frame_too_large": "A frame of the camera is larger than one may be: send smaller ones.",
    "live_frame_unreadable": "A message of the camera is no JPEG or WebP picture behind a frame's number.",
    "live_message_unknown": "The service knows one command of the camera's page: recalibrate.",
    "live_failed": "The process of the live portrait ended unexpectedly: begin anew; the service's log may say more.",
    "service_stopping": "The service is about to end: begin anew in a moment.",
}
"""Why a live portrait ends, beside what its target is refused for."""


class LiveSession:
    """A live portrait of an `owner`, by its `id`; `view_token` lets others look at it."""

    def __init__(self, id: str, owner: str, view_token: str, settings: Settings):
        self.id, self.owner, self.view_token, self._settings = id, owner, view_token, settings
        self.began_at = time.monotonic()
        self.status = "preparing"
        self.ended: dict[str, Any] | None = None
        self.ended_at = 0.0
        self.has_camera = False
        self._fed_at = self._seen_at = time.monotonic()
        self._process: LiveProcess | None = None
        self._outlets: set[Outlet] = set()
        self._last: dict[str, Any] = {"event": "preparing"}

    async def run(self, start: StartLive, order: LiveOrder) -> None:
        """From its start to its end."""
        watching = asyncio.get_running_loop().create_task(self._watch())
        try:
            self._process = await start(order)
            while self.ended is None and (message := await self._process.receive()) is not None:
                self._pass_on(*message)
        except OSError:
            structlog.get_logger().exception("live_not_started")
        finally:
            watching.cancel()
            self.end("live_failed")
            if self._process is not None:
                self._process.kill()

    def end(self, code: str, detail: str | None = None) -> None:
        """End it, for a reason; the first one counts."""
        if self.ended is not None:
            return
        self.status, self.ended_at = "ended", time.monotonic()
        self.ended = {"event": "ended", "code": code, "detail": detail or END_REASONS[code]}
        for outlet in self._outlets:
            outlet.tell(self.ended)
        if self._process is not None:
            self._process.kill()

    def feed(self, message: bytes) -> None:
        """Take in a message of the camera: four bytes of a number, and a picture."""
        self._fed_at = time.monotonic()
        if len(message) > self._settings.live_frame_mb * BYTES_PER_MEGABYTE:
            self.end("live_frame_too_large")
        elif len(message) <= 4:
            self.end("live_frame_unreadable")
        elif self._process is not None:
            self._process.send(FRAME_TAG, message)

    def command(self, text: str) -> None:
        """Pass on what the page asks for: `{"command": "recalibrate"}`."""
        self._fed_at = time.monotonic()
        try:
            command = json.loads(text)["command"]
        except (ValueError, KeyError, TypeError, RecursionError):
            command = None
        if command != "recalibrate":
            self.end("live_message_unknown")
        elif self._process is not None:
            self._process.send(COMMAND_TAG, json.dumps({"command": command}).encode())

    @property
    def viewers(self) -> int:
        """How many look."""
        return len(self._outlets)

    def look(self) -> Outlet:
        """Begin to look: the state as it is comes first."""
        outlet = Outlet()
        outlet.tell(self.ended or self._last)
        self._outlets.add(outlet)
        return outlet

    def look_away(self, outlet: Outlet) -> None:
        self._outlets.discard(outlet)

    def _pass_on(self, kind: bytes, data: bytes) -> None:
        if kind == FRAME_TAG:
            for outlet in self._outlets:
                outlet.show(data)
        elif kind == EVENT_TAG:
            event = json.loads(data)
            if event["event"] == "failed":
                self.end(str(event["code"]), event["detail"] or None)
                return
            self.status = "live" if event["event"] in ("ready", "no_face") else event["event"]
            self._last = event
            for outlet in self._outlets:
                outlet.tell(event)

    async def _watch(self) -> None:
        """End it when it is over its time, without a camera, or with nobody who looks."""
        while self.ended is None:
            await asyncio.sleep(SESSION_POLL_SECONDS)
            moment, idle = time.monotonic(), self._settings.live_idle_seconds
            looked = max((outlet.taken_at for outlet in self._outlets), default=self._seen_at)
            if moment - self.began_at > self._settings.live_seconds:
                self.end("live_time_limit")
            elif not self.has_camera:
                if moment - self.began_at > CAMERA_WAIT_SECONDS:
                    self.end("live_idle")
            elif self.status == "preparing":
                self._fed_at = self._seen_at = moment
            elif moment - self._fed_at > idle or moment - max(looked, self._seen_at) > idle:
                self.end("live_idle")
