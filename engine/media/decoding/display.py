"""How a decoded frame is to be shown: turned, mirrored and with square pixels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

import numpy as np
from av.sidedata.sidedata import SideData
from av.video.frame import VideoFrame

_TURNS: dict[tuple[int, int, int, int], Callable[[np.ndarray], np.ndarray]] = {
    # (a, b, c, d) of the display matrix: a point (x, y) of the frame is shown at (a x + c y, b x + d y), y down.
    (1, 0, 0, 1): lambda image: image,
    (0, 1, -1, 0): lambda image: np.rot90(image, -1),
    (-1, 0, 0, -1): lambda image: np.rot90(image, 2),
    (0, -1, 1, 0): lambda image: np.rot90(image, 1),
    (-1, 0, 0, 1): lambda image: image[:, ::-1],
    (1, 0, 0, -1): lambda image: image[::-1],
    (0, 1, 1, 0): lambda image: np.swapaxes(image, 0, 1),
    (0, -1, -1, 0): lambda image: np.rot90(image, 2).swapaxes(0, 1),
}


@dataclass(frozen=True)
class Orientation:
    """The quarter turn or mirroring of a display matrix: its signs (a, b, c, d)."""

    matrix: tuple[int, int, int, int] = (1, 0, 0, 1)

    @property
    def swaps_sides(self) -> bool:
        """Whether width and height change places."""
        return self.matrix[0] == 0

    def apply(self, image: np.ndarray) -> np.ndarray:
        """The image (H, W, ...) as it is to be shown, contiguous."""
        return np.ascontiguousarray(_TURNS[self.matrix](image))


def orientation_of(frame: VideoFrame) -> Orientation:
    """The orientation that the file asks for; turns that are not quarter turns are taken to the nearest one."""
    side = cast(SideData | None, frame.side_data.get("DISPLAYMATRIX"))
    if side is None:
        return Orientation()
    a, b, _, c, d = np.frombuffer(memoryview(side), "<i4")[:5].astype(float)
    if abs(a) + abs(d) >= abs(b) + abs(c):
        signs = (int(np.sign(a)), 0, 0, int(np.sign(d)))
    else:
        signs = (0, int(np.sign(b)), int(np.sign(c)), 0)
    return Orientation(signs) if signs in _TURNS else Orientation()
