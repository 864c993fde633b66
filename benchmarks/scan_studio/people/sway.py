"""Nobody stands still for eighty seconds: the body sways about the ankles, and the arms drift."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from benchmarks.scan_studio.people.subject import Subject

CHEST_SHARE = 0.72
"""Share of the height at which the sway is as far as it is said to be."""
TURN_RADIANS = 0.003
"""By which the body turns about the vertical, at most, for a sway of 5 mm."""
ARM_METRES = (0.008, 0.011)
"""By which the left and the right wrist drift, at most, for a sway of 5 mm."""
USUAL_METRES = 0.005
"""Of sway."""
SWAY_CYCLES = (0.8, 1.7, 3.1, 5.3, 8.9)
"""Of the sines that a smooth curve is made of, in the time of a film."""
MEASURED_MOMENT_COUNT = 2048
"""At which a curve's mean and greatest length are measured."""


class SmoothCurve:
    """A random curve in C dimensions over `seconds`: of zero mean, and of length 1 where it is longest."""

    def __init__(self, channels: int, seconds: float, seed: int, cycles: tuple[float, ...] = SWAY_CYCLES):
        random = np.random.default_rng(seed)
        self._rates = (
            2 * np.pi * np.array(cycles)[:, None] / seconds * random.uniform(0.9, 1.1, (len(cycles), channels))
        )
        self._phases = random.uniform(0, 2 * np.pi, (len(cycles), channels))
        self._heights = random.uniform(0.5, 1, (len(cycles), channels)) / np.sqrt(np.array(cycles))[:, None]
        samples = self._sum(np.linspace(0, seconds, MEASURED_MOMENT_COUNT))
        self._mean = samples.mean(0)
        self._longest = float(np.linalg.norm(samples - self._mean, axis=1).max())

    def __call__(self, second: ArrayLike) -> NDArray[np.float64]:
        """(..., C) at these moments (...,)."""
        return np.asarray((self._sum(np.asarray(second, np.float64)) - self._mean) / self._longest)

    def _sum(self, second: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray((self._heights * np.sin(self._rates * second[..., None, None] + self._phases)).sum(-2))


@dataclass(frozen=True)
class Stance:
    """How somebody stands at a moment: their arms turned about the shoulders, then all of them moved."""

    rotation: NDArray[np.float64]
    """(3, 3) from the body at rest to the room."""
    translation: NDArray[np.float64]
    """(3,) metres, after the rotation."""
    arms: NDArray[np.float64]
    """(2, 3) rotation vectors of the left and the right arm; vertices turn as far as they go with it."""

    def place(self, subject: Subject) -> NDArray[np.float64]:
        """The subject's vertices (V, 3) in the room, metres."""
        moved = subject.vertices
        for arm, vector in zip(subject.arms, self.arms, strict=False):
            turn = Rotation.from_rotvec(vector).as_matrix() - np.eye(3)
            moved = moved + arm.weights[:, None] * ((subject.vertices - arm.pivot) @ turn.T)
        return np.asarray(moved @ self.rotation.T + self.translation)


class Sway:
    """The sway of a subject over a film of `seconds`: its chest moves by `metres` at most from where it is in the mean. `seed`
    decides how."""

    def __init__(self, subject: Subject, metres: float, seconds: float, seed: int):
        self._subject, self._metres = subject, metres
        self._lean = SmoothCurve(2, seconds, seed)
        self._turn = SmoothCurve(1, seconds, seed + 1)
        self._arms = [SmoothCurve(2, seconds, seed + 2 + k) for k in range(2)]

    def __call__(self, second: float) -> Stance:
        """How the subject stands."""
        share = self._metres / USUAL_METRES
        across, forward = self._metres * self._lean(second) / (CHEST_SHARE * self._subject.height)
        about = TURN_RADIANS * share * float(self._turn(second)[0])
        rotation = Rotation.from_rotvec([forward, about, -across]).as_matrix()
        arms = np.zeros((2, 3))
        for k, arm in enumerate(self._subject.arms):
            up, along = share * ARM_METRES[k] * self._arms[k](second) / arm.reach
            arms[k] = (0.0, along, up)
        return Stance(rotation, np.zeros(3), arms)
