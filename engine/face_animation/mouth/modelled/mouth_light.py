"""Where in a mouth what is seen: along it from corner to corner, and below the upper lip; and what light there is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import UPPER_INNER_LIP

LIP_SHADE, LIP_SHADE_WIDTH = 0.15, 0.1
"""Of the light, that the upper lip keeps from teeth at its edge, and widths of the mouth below it up to which it does."""
CORNER_SHADE, CORNER_SHADE_WIDTH = 0.3, 0.25


class InMouth(NamedTuple):
    """(h, w) each: where a pixel is `along` the mouth, from 0 to 1, and how far `under` the upper inner lip, in widths of the mouth."""

    along: NDArray[np.float64]
    under: NDArray[np.float64]

    def light(self) -> NDArray[np.float32]:
        """(h, w) that reaches teeth: less below the upper lip, and in the mouth's corners."""
        corners = np.clip(np.minimum(self.along, 1 - self.along) / CORNER_SHADE_WIDTH, 0, 1)
        lips = np.clip(self.under / LIP_SHADE_WIDTH, 0, 1)
        return np.asarray((1 - LIP_SHADE * (1 - lips) ** 2) * (1 - CORNER_SHADE * (1 - corners) ** 2), np.float32)


def in_mouth(face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]) -> InMouth:
    """Of the pixels of a part of `shape` (h, w) whose first is at `corner` (2,) of the picture of a `face` (478, 2)."""
    right, left = face[UPPER_INNER_LIP[0], :2], face[UPPER_INNER_LIP[-1], :2]
    width = max(float(np.linalg.norm(left - right)), 1.0)
    axis = (left - right) / width
    down = np.array([-axis[1], axis[0]])
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    seen = np.stack([columns, rows], axis=-1) + corner - right
    along, height = seen @ axis / width, seen @ down / width
    upper = face[list(UPPER_INNER_LIP), :2] - right
    return InMouth(along, height - np.interp(along, upper @ axis / width, upper @ down / width))
