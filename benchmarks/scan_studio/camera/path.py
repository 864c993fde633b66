"""Where the phone is held: two orbits about the body, or round the head, over its crown and under its chin."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from benchmarks.scan_studio.conditions import NAMED_CONDITIONS, Conditions
from benchmarks.scan_studio.people.subject import Subject
from benchmarks.scan_studio.people.sway import SWAY_CYCLES, SmoothCurve
from engine.geometry.camera import Camera

FOCAL_SHARE = 0.85
"""Focal length in long sides of the picture: a phone's main camera as it films, about 30 mm on 36 x 24."""
FOCUS_BREATHING_SHARE = 0.006
"""Share by which the focal length changes, at most, as the focus moves."""
WANDER_METRES = (0.07, 0.05, 0.07)
"""How far a hand strays from the path along the room's axes, about, at most."""
WANDER_DEGREES = (1.6, 1.6, 2.0)
"""How far a hand strays from its aim, up, aside and about the view, about, at most."""
NEAR_SHARE = 0.3
"""Share of the straying when the head is filmed from near."""
TREMOR_DEGREES = 0.12
"""Of a hand's tremor, at most; in bad moments three times as much."""
TREMOR_HERTZ = (2.3, 3.7, 5.1)
"""Of which the tremor is made."""

BODY_SECONDS = 80.0
"""As long as the paper's film of the body takes."""
HEAD_SECONDS = 30.0
"""As long as the paper's film of the head takes."""

BODY_CAMERA_KEYS = (
    (0.0, 0.0, 0.84, 0.68, 2.0),
    (0.48, 362.0, 0.84, 0.68, 2.0),
    (0.53, 378.0, 0.42, 0.36, 1.95),
    (1.0, 735.0, 0.42, 0.36, 1.95),
)
"""Share of the time; degrees round to the subject's left; heights of the camera and of its aim in the subject's; metres
away."""
HEAD_CAMERA_KEYS = (
    (0.0, 0.0, 2.0, 0.6),
    (0.54, 363.0, 4.0, 0.6),
    (0.64, 372.0, 48.0, 0.62),
    (0.72, 330.0, 62.0, 0.62),
    (0.80, 400.0, 40.0, 0.62),
    (0.90, 405.0, -24.0, 0.6),
    (1.0, 310.0, -32.0, 0.6),
)
"""Share of the time; degrees round to the subject's left; degrees up; metres from the middle of the head."""


@dataclass(frozen=True)
class HandHeld:
    """A camera led by hand along a path, at any moment of it."""

    subject: Subject
    """Who is filmed."""
    size: tuple[int, int]
    """(width, height) of the upright picture."""
    seconds: float
    """How long it takes."""
    seed: int
    """Of how the hand strays."""
    head: bool
    """Whether the head is filmed."""
    conditions: Conditions = NAMED_CONDITIONS["good"]

    def cameras(self, seconds: NDArray[np.float64]) -> list[Camera]:
        """As it is at these moments (N,)."""
        width, height = self.size
        eyes, aims = self._path(seconds)
        near = NEAR_SHARE if self.head else 1.0
        eyes = eyes + near * np.array(WANDER_METRES) * self._curve(1, 3)(seconds)
        stray = np.array(WANDER_DEGREES) * self._curve(2, 3)(seconds)
        shaking = self._curve(3, 3, tuple(hertz * self.seconds for hertz in TREMOR_HERTZ))(seconds)
        bad = 1 + 2 * np.clip(self._curve(4, 1, (7.3, 11.9))(seconds), 0, 1) ** 2
        vectors = np.radians(stray + self.conditions.tremor * TREMOR_DEGREES * bad * shaking)
        focal = FOCAL_SHARE * max(self.size) * (1 + FOCUS_BREATHING_SHARE * self._curve(5, 1)(seconds)[:, 0])
        lens = Camera((0.0, 0.0, 0.0), 1.0, ((width - 1) / 2, (height - 1) / 2), (height, width))
        found = []
        for eye, aim, vector, length in zip(eyes, aims, vectors, focal, strict=True):
            level = lens.aimed(eye, aim)
            axes = Rotation.from_rotvec(vector).as_matrix() @ np.array(level.axes)
            found.append(replace(level, focal=float(length), axes=tuple(map(tuple, axes.tolist()))))
        return found

    def _curve(self, number: int, channels: int, cycles: tuple[float, ...] = SWAY_CYCLES) -> SmoothCurve:
        return SmoothCurve(channels, self.seconds, self.seed + 10 * number, cycles)

    def _path(self, seconds: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N, 3) eyes and (N, 3) what they look at."""
        keys = np.array(HEAD_CAMERA_KEYS if self.head else BODY_CAMERA_KEYS)
        values = PchipInterpolator(keys[:, 0], keys[:, 1:])(np.clip(seconds / self.seconds, 0, 1))
        round_about = np.radians(self.conditions.round_about(values[:, 0]))
        if self.head:
            up, away = np.radians(values[:, 1]), values[:, 2:]
            ways = np.stack([np.cos(up) * np.sin(round_about), np.sin(up), np.cos(up) * np.cos(round_about)], 1)
            aims = np.broadcast_to(self.subject.head, ways.shape)
            return aims + away * ways, aims
        level = np.stack([np.sin(round_about), 0 * round_about, np.cos(round_about)], 1)
        eyes = values[:, 3:] * level + np.outer(values[:, 1] * self.subject.height, [0, 1, 0])
        return eyes, np.outer(values[:, 2] * self.subject.height, [0, 1, 0])
