"""The studio: a subject, a room, a hand that leads a phone, and what the phone writes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.film import FilmFormat, write_film
from benchmarks.scan_studio.path import BODY_SECONDS, HEAD_SECONDS, HandHeld
from benchmarks.scan_studio.room import furnished_room
from benchmarks.scan_studio.scene import SAMPLE_OFFSETS, Scene
from benchmarks.scan_studio.sensor import Sensor
from benchmarks.scan_studio.subject import Subject
from benchmarks.scan_studio.sway import USUAL_METRES, Sway
from benchmarks.scan_studio.truth import FilmTruth, Truth, write_truth

EXPOSURE_SECONDS = 1 / 50
"""Indoors."""


@dataclass(frozen=True)
class Order:
    """What is to be filmed."""

    frames: Mapping[str, int]
    """How many of "body" and of "head"; 0: it is not filmed."""
    size: tuple[int, int] = (360, 640)
    """(width, height) of the upright films, both even."""
    film_format: FilmFormat = "h264"
    sway: float = USUAL_METRES
    """Metres that the subject's chest moves, at most; 0: nothing of it moves."""
    seed: int = 0
    """Of all that chance decides."""


@dataclass(frozen=True)
class Take:
    """One of the two films while it is made."""

    name: str
    """"body" or "head"."""
    subject: Subject
    order: Order

    @property
    def seconds(self) -> float:
        """How long it lasts; its frames are spread over them."""
        return BODY_SECONDS if self.name == "body" else HEAD_SECONDS

    @property
    def moments(self) -> NDArray[np.float64]:
        """(F,) seconds of the middle of each exposure."""
        return (np.arange(self.order.frames[self.name]) + 0.5) * self.seconds / self.order.frames[self.name]

    @property
    def seed(self) -> int:
        """Of its own for each film."""
        return 1000 * self.order.seed + (500 if self.name == "head" else 0)

    @property
    def hand(self) -> HandHeld:
        """Who films."""
        return HandHeld(self.subject, self.order.size, self.seconds, self.seed + 100, self.name == "head")

    @property
    def sway(self) -> Sway:
        """Of who is filmed."""
        return Sway(self.subject, self.order.sway, self.seconds, self.seed + 200)

    @property
    def sensor(self) -> Sensor:
        """Of the phone."""
        return Sensor(self.seconds, self.seed + 300)

    def truth(self) -> FilmTruth:
        """What its frames show."""
        sway, moments = self.sway, self.moments
        cameras = tuple(self.hand.cameras(moments))
        return FilmTruth(cameras, tuple(map(sway, moments.tolist())), self.sensor.gains(moments), moments)

    def frames(self, scene: Scene) -> Iterator[NDArray[np.float32]]:
        """Linear light (H, W, 3) each, as the phone measures it."""
        sway, sensor, count = self.sway, self.sensor, len(SAMPLE_OFFSETS)
        spread = EXPOSURE_SECONDS * ((np.arange(count) + 0.5) / count - 0.5)
        within = self.moments[:, None] + spread
        cameras = self.hand.cameras(within.ravel())
        for frame, gains in enumerate(sensor.gains(self.moments)):
            stands = [sway(second).place(self.subject) for second in within[frame].tolist()]
            light = scene.expose(cameras[frame * count : (frame + 1) * count], list(stands))
            yield sensor.read(light, gains, frame)


def film(subject: Subject, order: Order, folder: Path) -> None:
    """Write `body.mp4` and `head.mp4` into a folder, and the truth beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = Scene(furnished_room(order.seed), subject)
    takes = [Take(name, subject, order) for name, count in order.frames.items() if count]
    made = {"format": order.film_format, "sway": order.sway, "seed": order.seed, "frames": dict(order.frames)}
    write_truth(folder, Truth(subject, {take.name: take.truth() for take in takes}, made))
    for take in takes:
        write_film(folder / f"{take.name}.mp4", take.frames(scene), order.size, order.film_format)
