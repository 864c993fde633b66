"""The light that reaches what is in a mouth: less below the upper lip, and in the mouth's corners."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.face_animation.mouth.lip_contours import UPPER_INNER_LIP

LIP_SHADE_SHARE, LIP_SHADE_MOUTH_WIDTHS = 0.28, 0.06
"""Of the light, that the upper lip keeps from teeth at its edge, and widths of the mouth below it up to which it does."""
CORNER_SHADE_SHARE, CORNER_SHADE_MOUTH_WIDTHS = 0.45, 0.3


def mouth_light(
    face: NDArray[np.floating], corner: NDArray[np.floating], shape: tuple[int, int]
) -> NDArray[np.float32]:
    """(h, w) of the light in the mouth of a `face` (478, 2), for the pixels of a part of `shape` (h, w) whose first is at `corner` (2,) of the
    picture."""
    upper = face[list(UPPER_INNER_LIP), :2].astype(np.float32)
    across = upper[-1] - upper[0]
    width = max(float(np.linalg.norm(across)), 1.0)
    axis = across / width
    seen = (upper - upper[0]) @ np.array([axis, (-axis[1], axis[0])]).T / width
    start = (np.asarray(corner, np.float32) - upper[0]) / width
    return np.asarray(_light(*shape, start, np.float32(1 / width), axis, seen.astype(np.float32)), np.float32)


@njit(fastmath=True, nogil=True)
def _light(height, width, start, step, axis, lip):  # type: ignore[no-untyped-def]
    """From `start` (2,) on, a pixel is a `step`, in widths of the mouth; `lip` (11, 2) the upper lip along and across the mouth."""
    out = np.empty((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            right = start[0] + x * step
            down = start[1] + y * step
            along = right * axis[0] + down * axis[1]
            across = down * axis[0] - right * axis[1]
            k = 0
            while k < len(lip) - 2 and along > lip[k + 1, 0]:
                k += 1
            run = max(lip[k + 1, 0] - lip[k, 0], np.float32(1e-6))
            t = min(max((along - lip[k, 0]) / run, np.float32(0)), np.float32(1))
            under = across - (lip[k, 1] + t * (lip[k + 1, 1] - lip[k, 1]))
            lips = 1 - min(max(under / np.float32(LIP_SHADE_MOUTH_WIDTHS), np.float32(0)), np.float32(1))
            sides = 1 - min(
                max(min(along, 1 - along) / np.float32(CORNER_SHADE_MOUTH_WIDTHS), np.float32(0)), np.float32(1)
            )
            out[y, x] = (1 - np.float32(LIP_SHADE_SHARE) * lips * lips) * (
                1 - np.float32(CORNER_SHADE_SHARE) * sides * sides
            )
    return out
