"""Steps where two frames meet, spread over the texture until they are not seen.

Source: the paper, section 3.5, after P. Perez, M. Gangnet, A. Blake, Poisson image editing, SIGGRAPH 2003: the texture keeps the
gradients of its frames, and has none of its own between them. What is solved for is the correction, which is harmonic but
for the steps at seams, and not the colours: what the solver leaves is then a part of a small correction.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.avatar.texture.painting import PaintedTexture
from engine.imaging.filling.poisson import membrane

MAX_JUMP_GREY_LEVELS = 24.0
"""Grey levels: a larger difference of two frames is something that they show at different places, no exposure, and counts so
much."""
LEVELLING_V_CYCLES = 3
LEVELLED_STRIP_ROWS = 256
"""Rows that are corrected at once."""


def level_seams(painted: PaintedTexture, charts: NDArray[np.int32]) -> None:
    """Take the steps out of `painted.colours`, in place. `charts` (S, S): which chart each texel shows, -1 beside them.

    Along the rims of charts nothing is changed, so that the two sides of a cut stay as alike as they are. One channel is
    solved at a time, to save memory.
    """
    inside = _inner(charts)
    size = len(charts)
    nothing = np.zeros((size, size, 1), np.float32)
    limited = np.clip(painted.jumps, -MAX_JUMP_GREY_LEVELS, MAX_JUMP_GREY_LEVELS)
    for channel in range(3):
        divergence = np.zeros(size * size, np.float32)
        np.subtract.at(divergence, painted.seams[:, 0], limited[:, channel])
        np.add.at(divergence, painted.seams[:, 1], limited[:, channel])
        correction = membrane(nothing, inside, LEVELLING_V_CYCLES, divergence.reshape(size, size, 1))[..., 0]
        for first in range(0, size, LEVELLED_STRIP_ROWS):
            rows = slice(first, first + LEVELLED_STRIP_ROWS)
            corrected = np.clip(np.rint(painted.colours[rows, :, channel] + correction[rows]), 0, 255)
            painted.colours[rows, :, channel] = np.where(painted.known[rows], corrected, 0)


def _inner(charts: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(S, S) texels of charts of which all four neighbours are on the same chart."""
    low = cv2.erode(charts.astype(np.float32), np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.uint8))
    high = cv2.dilate(charts.astype(np.float32), np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.uint8))
    return np.asarray((low == high) & (charts >= 0))
