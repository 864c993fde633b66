"""An eyeball behind the lids of a face, and how it turns.

A face mesh's lids lie flatter than people's, and their corners reach beyond a true eyeball. So the ball is larger than
people's, as large as fills the opening. It turns by less, so that its iris travels as far.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.body.face.face_capture import MAX_GAZE_TRAVEL_EYE_WIDTHS
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS

EYE_AND_IRIS_VERTICES = {"Left": (LEFT_EYE, LEFT_IRIS), "Right": (RIGHT_EYE, RIGHT_IRIS)}
BALL_OPENING_RATIO = 1.12
"""How many times as wide as its opening an eyeball is: its rim is never seen."""
CAP_RADIANS = np.radians(80)
"""Radians about the iris to which an eyeball's surface is made."""
EYEBALL_RINGS, EYEBALL_SECTORS = 20, 40
RIM_DEPTH_EYE_DISTANCES = 0.1
"""Eye distances that the rim of the lids reaches behind them."""


@dataclass(frozen=True)
class Eyeball:
    """Of a head from the front, in eye distances, y down and z away.

    centre : (3,).
    radius : of the ball.
    vertices : (V, 3), rings about where it looks to.
    triangles : (T, 3), counter-clockwise from outside.
    uv : (V, 2) places on its texture, whose middle is the iris' and whose edge is the cap's.
    """

    centre: NDArray[np.float64]
    radius: float
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float32]
    side: str
    width: float

    def turned(self, way: str) -> NDArray[np.float64]:
        """(V, 3) by how much it moves its vertices to look `way` ("In", "Out", "Up" or "Down") as far as eyes do."""
        angle = np.arcsin(min(MAX_GAZE_TRAVEL_EYE_WIDTHS[way] * self.width / self.radius, 0.9))
        if way in ("Up", "Down"):
            turn = np.array([-angle if way == "Up" else angle, 0, 0])
        else:
            leftward = (way == "In") == (self.side == "Left")  # in the picture
            turn = np.array([0, angle if leftward else -angle, 0])
        away = self.vertices - self.centre
        return np.asarray(Rotation.from_rotvec(turn).apply(away) - away, np.float64)


def eyeball(face: NDArray[np.floating], side: str, lids: NDArray[np.floating]) -> Eyeball:
    """That of one side of a `face` (478, 3) from the front: just behind all of `lids` (K, 3), wherever lids are when they move."""
    contour, iris = EYE_AND_IRIS_VERTICES[side]
    rim = np.asarray(face, np.float64)[list(contour)]
    width = float(np.linalg.norm(rim[8] - rim[0]))
    radius = BALL_OPENING_RATIO * width / 2
    middle = (rim[:, :2].min(axis=0) + rim[:, :2].max(axis=0)) / 2
    near = np.linalg.norm(lids[:, :2] - middle, axis=1) < radius / BALL_OPENING_RATIO
    bulge = np.sqrt(radius**2 - ((lids[near, :2] - middle) ** 2).sum(axis=1))
    centre = np.array([*middle, float((lids[near, 2] + bulge).max())])
    look = np.asarray(face, np.float64)[iris[0], :2] - middle
    pole = np.array([*look, -np.sqrt(max(radius**2 - float(look @ look), 1e-9))]) / radius
    across, down = np.linspace(0, CAP_RADIANS, EYEBALL_RINGS), np.linspace(0, 2 * np.pi, EYEBALL_SECTORS + 1)
    angle, turn = (one.ravel() for one in np.meshgrid(across, down, indexing="ij"))
    local = np.column_stack([np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), -np.cos(angle)])
    towards = Rotation.align_vectors(pole[None], np.array([[0.0, 0.0, -1.0]]))[0]
    uv = 0.5 + 0.5 * (angle / CAP_RADIANS)[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    return Eyeball(centre, radius, centre + radius * towards.apply(local), _grid(), uv.astype(np.float32), side, width)


def lid_rim(contour: NDArray[np.floating]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """(32, 3) a band from an eye's `contour` (16, 3) to behind it, and its triangles (T, 3), seen from within the opening."""
    contour = np.asarray(contour, np.float64)
    count = len(contour)
    here, after = np.arange(count), np.roll(np.arange(count), -1)
    triangles = np.concatenate(
        [np.stack([here, after, after + count], axis=1), np.stack([here, after + count, here + count], axis=1)]
    )
    points = np.concatenate([contour, contour + np.array([0, 0, RIM_DEPTH_EYE_DISTANCES])])
    (ax, ay), (bx, by) = contour[4, :2] - contour[0, :2], contour[8, :2] - contour[0, :2]
    clockwise = ax * by > ay * bx
    return points, (triangles[:, ::-1] if clockwise else triangles).astype(np.int32)


def _grid() -> NDArray[np.int32]:
    index = np.arange(EYEBALL_RINGS * (EYEBALL_SECTORS + 1)).reshape(EYEBALL_RINGS, EYEBALL_SECTORS + 1)
    a, b, c, d = index[:-1, :-1].ravel(), index[:-1, 1:].ravel(), index[1:, 1:].ravel(), index[1:, :-1].ravel()
    return np.concatenate([np.stack([a, b, c], axis=1)[EYEBALL_SECTORS:], np.stack([a, c, d], axis=1)]).astype(np.int32)
