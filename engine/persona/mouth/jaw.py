"""How far a face's jaw is open, by where its chin is: a hinge before the ears."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

CHIN = (152, 148, 377, 176, 400, 175, 199)
HINGE = (234, 454)
"""Before the ears."""
MAX_ANGLE = 0.6
"""Radians: no jaw opens wider."""
ROUNDS = 3
"""Of Newton's."""


class Jaw(NamedTuple):
    """angle : radians by which it is open. aside : by which the chin is moved along x. hinge : (2,) y and z of its axis."""

    angle: float
    aside: float
    hinge: NDArray[np.float64]

    def moved(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """(..., 3) where points of the jaw, given at rest from the front, y down and z away, are."""
        y, z = points[..., 1] - self.hinge[0], points[..., 2] - self.hinge[1]
        cos, sin = np.cos(self.angle), np.sin(self.angle)
        return np.stack(
            [points[..., 0] + self.aside, self.hinge[0] + y * cos - z * sin, self.hinge[1] + z * cos + y * sin], axis=-1
        )


def jaw_of(face: NDArray[np.floating], shut: NDArray[np.floating]) -> Jaw:
    """That of a `face` (478, 2 or 3), of which x and y count, whose jaw is closed in `shut` (478, 3): both from the front, in units of their
    own."""
    hinge = shut[list(HINGE), 1:].mean(axis=0)
    chin, now = shut[list(CHIN)].mean(axis=0), np.asarray(face, np.float64)[list(CHIN), :2].mean(axis=0)
    down, forward = chin[1] - hinge[0], hinge[1] - chin[2]
    wanted = now[1] - hinge[0]
    angle = 0.0
    for _ in range(ROUNDS):
        off = down * np.cos(angle) + forward * np.sin(angle) - wanted
        angle -= off / max(forward * np.cos(angle) - down * np.sin(angle), 0.3 * forward)
    return Jaw(float(np.clip(angle, 0, MAX_ANGLE)), float(now[0] - chin[0]), np.asarray(hinge, np.float64))
