"""The studio: a subject, a room, a hand that leads a phone, and what the phone writes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.scan_studio.camera.path import BODY_SECONDS, HEAD_SECONDS, HandHeld
from benchmarks.scan_studio.camera.sensor import Sensor
from benchmarks.scan_studio.conditions import COMPANY_METRES, NAMED_CONDITIONS, Conditions
from benchmarks.scan_studio.film import FilmFormat, write_film
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.sway import USUAL_METRES, Stance, Sway
from benchmarks.scan_studio.scenery.room import furnished_room
from benchmarks.scan_studio.scenery.scene import Scene
from benchmarks.scan_studio.truth import FilmTruth, Truth, write_truth


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
    conditions: str = "good"
    """One of `NAMED_CONDITIONS`."""


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
        return (BODY_SECONDS if self.name == "body" else HEAD_SECONDS) / self.conditions.hurry

    @property
    def conditions(self) -> Conditions:
        """How it is taken."""
        return NAMED_CONDITIONS[self.order.conditions]

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
        return HandHeld(
            self.subject, self.order.size, self.seconds, self.seed + 100, self.name == "head", self.conditions
        )

    @property
    def stance_at(self) -> Callable[[float], Stance]:
        """How who is filmed stands at a second."""
        sway = Sway(self.subject, self.order.sway, self.seconds, self.seed + 200)

        def stance(second: float) -> Stance:
            still = sway(second)
            return replace(still, translation=still.translation + self.conditions.walked(second / self.seconds))

        return stance

    @property
    def sensor(self) -> Sensor:
        """Of the phone."""
        return Sensor(self.seconds, self.seed + 300)

    def truth(self) -> FilmTruth:
        """What its frames show."""
        moments = self.moments
        cameras, stances = self.hand.cameras(moments), map(self.stance_at, moments.tolist())
        return FilmTruth(tuple(cameras), tuple(stances), self.gains(), moments)

    def gains(self) -> NDArray[np.float64]:
        """(F, 3) by what red, green and blue light are multiplied in each frame."""
        return self.conditions.brightness * self.sensor.gains(self.moments)

    def frames(self, scene: Scene) -> Iterator[NDArray[np.float32]]:
        """Linear light (H, W, 3) each, as the phone measures it."""
        stance_at, sensor, count = self.stance_at, self.sensor, self.conditions.exposure_moments
        spread = self.conditions.exposure_seconds * ((np.arange(count) + 0.5) / count - 0.5)
        within = self.moments[:, None] + spread
        cameras = self.hand.cameras(within.ravel())
        for frame, gains in enumerate(self.gains()):
            stands = [stance_at(second).place(self.subject) for second in within[frame].tolist()]
            light = scene.expose(cameras[frame * count : (frame + 1) * count], list(stands))
            yield sensor.read(light, gains, frame)


def film(subject: Subject, order: Order, folder: Path) -> None:
    """Write `body.mp4` and `head.mp4` into a folder, and the truth beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    company = COMPANY_METRES if NAMED_CONDITIONS[order.conditions].company else None
    scene = Scene(furnished_room(order.seed), subject, company)
    takes = [Take(name, subject, order) for name, count in order.frames.items() if count]
    made = {
        "format": order.film_format,
        "conditions": order.conditions,
        "sway": order.sway,
        "seed": order.seed,
        "frames": dict(order.frames),
    }
    write_truth(folder, Truth(subject, {take.name: take.truth() for take in takes}, made))
    for take in takes:
        write_film(folder / f"{take.name}.mp4", take.frames(scene), order.size, order.film_format)
