"""How the camera moves while a character acts: not at all, around it, or sideways past it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:  # a job kind's options name the moves, and stay light
    from engine.geometry.camera import Camera

Move = Literal["fixed", "orbit", "parallax"]

CAMERA_MOVES: tuple[Move, ...] = get_args(Move)

ORBIT_DEGREES = 24.0
"""Degrees that the camera goes round to either side: further, the back of the picture would have to be known."""

SLIDE_SHARE = 0.10
"""How far the camera slides to either side, as a share of its distance to the target."""

PERIOD_SECONDS = 8.0
"""Seconds from the middle to one side, to the other and back."""


def camera_at(
    move: Move,
    start: Camera,
    target: ArrayLike,
    second: float,
    reach: float | None = None,
    period: float = PERIOD_SECONDS,
) -> Camera:
    """The camera at a moment; at second 0 it is `start`, whatever the move.

    Parameters
    ----------
    move : "fixed"; "orbit" swings around the upright axis through `target` and back, `reach` degrees to either side;
        "parallax" slides sideways by `reach` of the distance to `target`, looking in the same direction. Its lens is
        shifted then: the target's plane stays where it is in the picture, and all else moves against it.
    target : (3,) metres, a point in front of the camera.
    """
    swing = float(np.sin(2 * np.pi * second / period))
    if move == "orbit":
        return _turned(
            start, np.asarray(target, np.float64), np.radians(ORBIT_DEGREES if reach is None else reach) * swing
        )
    if move == "parallax":
        right, _, back = np.array(start.axes)
        distance = float((np.array(start.eye) - target) @ back)
        step = (SLIDE_SHARE if reach is None else reach) * swing
        x, y, z = (np.array(start.eye) + step * distance * right).tolist()
        return replace(start, eye=(x, y, z), centre=(start.centre[0] + step * start.focal, start.centre[1]))
    return start


def _turned(camera: Camera, pivot: np.ndarray, angle: float) -> Camera:
    """The camera carried around the upright axis through `pivot`, counter-clockwise seen from above."""
    c, s = float(np.cos(angle)), float(np.sin(angle))
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    x, y, z = (turn @ (np.array(camera.eye) - pivot) + pivot).tolist()
    axes = (np.array(camera.axes) @ turn.T).tolist()
    return replace(camera, eye=(x, y, z), axes=tuple(map(tuple, axes)))
