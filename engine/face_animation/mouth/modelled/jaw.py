"""How far a face's jaw is open, by where its chin is: a hinge before the ears."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import INNER_LOWER_LIP_VERTEX

CHIN_VERTICES = (152, 148, 377, 176, 400, 175, 199)
JAW_HINGE_VERTICES = (234, 454)
"""Before the ears."""
MAX_JAW_RADIANS = 0.9
"""Radians: farther than jaws open, since faces are carried over to others whose chins are shorter."""
JAW_NEWTON_STEPS = 3
"""Of Newton's."""


class Jaw(NamedTuple):
    """angle : radians by which it is open.
    aside : by which it is moved along x, as chin and lower lip tell.
    hinge : (2,) y and z of its axis.
    """

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
    hinge = shut[list(JAW_HINGE_VERTICES), 1:].mean(axis=0)
    chin, now = (
        shut[list(CHIN_VERTICES)].mean(axis=0),
        np.asarray(face, np.float64)[list(CHIN_VERTICES), :2].mean(axis=0),
    )
    lip = float(face[INNER_LOWER_LIP_VERTEX, 0] - shut[INNER_LOWER_LIP_VERTEX, 0])
    aside = (float(now[0] - chin[0]) + lip) / 2
    return Jaw(_angle(chin, float(now[1]), hinge), aside, np.asarray(hinge, np.float64))


def held_between(jaw: Jaw, point: NDArray[np.floating], heights: tuple[float, float]) -> Jaw:
    """The jaw open as nearly as it is, that a `point` (3,) of it, given at rest, is between two `heights`, the upper one first."""
    least, most = (_angle(np.asarray(point, np.float64), height, jaw.hinge) for height in heights)
    return jaw._replace(angle=float(np.clip(jaw.angle, least, most)))


def _angle(point: NDArray[np.float64], height: float, hinge: NDArray[np.float64]) -> float:
    """Radians by which the jaw is open where a point (3,) of it is at a `height`."""
    down, forward = point[1] - hinge[0], hinge[1] - point[2]
    angle = 0.0
    for _ in range(JAW_NEWTON_STEPS):
        off = down * np.cos(angle) + forward * np.sin(angle) - (height - hinge[0])
        angle -= off / max(forward * np.cos(angle) - down * np.sin(angle), 0.3 * forward)
    return float(np.clip(angle, 0, MAX_JAW_RADIANS))
