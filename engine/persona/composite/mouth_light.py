"""Where in a mouth what is seen: along it from corner to corner, and down from lip to lip; and what light there is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import LOWER_INNER_LIP, UPPER_INNER_LIP

TONGUE_GAPS = (0.1, 0.3)
"""Widths of the mouth by which lips are apart where the tongue begins to be seen, and is wholly."""
TONGUE_TOP = 0.45
"""Of the way from lip to lip, from which on down it is."""
TONGUE_LIGHT = 0.7
LIP_SHADE, LIP_SHADE_WIDTH = 0.15, 0.1
"""Of the light, that the upper lip keeps from teeth at its edge, and widths of the mouth below it up to which it does."""
CORNER_SHADE, CORNER_SHADE_WIDTH = 0.3, 0.25


class InMouth(NamedTuple):
    """(h, w) each: where a pixel is `along` the mouth, from 0 to 1, and how far `under` the upper inner lip and `above` the lower one,
    in widths of the mouth."""

    along: NDArray[np.float64]
    under: NDArray[np.float64]
    above: NDArray[np.float64]

    def light(self) -> NDArray[np.float32]:
        """(h, w) that reaches teeth: less below the upper lip, and in the mouth's corners."""
        corners = np.clip(np.minimum(self.along, 1 - self.along) / CORNER_SHADE_WIDTH, 0, 1)
        lips = np.clip(self.under / LIP_SHADE_WIDTH, 0, 1)
        return np.asarray((1 - LIP_SHADE * (1 - lips) ** 2) * (1 - CORNER_SHADE * (1 - corners) ** 2), np.float32)

    def tongue(self) -> NDArray[np.float32]:
        """(h, w) how much of the tongue is seen: it rises behind the lower lip, the more the wider the mouth is open."""
        height = np.maximum(self.under + self.above, 1e-6)
        wide = np.clip((height - TONGUE_GAPS[0]) / (TONGUE_GAPS[1] - TONGUE_GAPS[0]), 0, 1)
        rise = np.clip((self.under / height - TONGUE_TOP) / (1 - TONGUE_TOP), 0, 1)
        across = np.clip(1 - (2 * self.along - 1) ** 2, 0, 1)
        return np.asarray(TONGUE_LIGHT * wide * across * rise * rise * (3 - 2 * rise), np.float32)


def in_mouth(face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]) -> InMouth:
    """Of the pixels of a part of `shape` (h, w) whose first is at `corner` (2,) of the picture of a `face` (478, 2)."""
    right, left = face[UPPER_INNER_LIP[0], :2], face[UPPER_INNER_LIP[-1], :2]
    width = max(float(np.linalg.norm(left - right)), 1.0)
    axis = (left - right) / width
    down = np.array([-axis[1], axis[0]])
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    seen = np.stack([columns, rows], axis=-1) + corner - right
    along, height = seen @ axis / width, seen @ down / width
    upper, lower = (face[list(lip), :2] - right for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    top, bottom = (np.interp(along, lip @ axis / width, lip @ down / width) for lip in (upper, lower))
    return InMouth(along, height - top, bottom - height)
