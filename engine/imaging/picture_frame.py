"""A picture within the picture: plain margins, mats and thin frames that somebody put around it, which do not move with what it shows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.imaging.window import Window

PLAIN_LEVELS = 6
"""Levels by which the pixels of a margin differ from one another at most, in any channel: JPEG's noise."""
PLAIN_SHARE = 0.98
"""Of the pixels of a line along the border that are of the margin's colour."""
EDGE_LEVELS, FRAME_EDGE_SHARE, EDGE_PIXELS = 12, 0.6, 2
"""What a margin's end is: of so large a share of a line's pixels each changes by so many levels, within so many lines.
A backdrop ends at a person, or fades."""
RINGING_LINES = 16
"""Lines before the edge that JPEG may have made uneven: a block of its colours."""
LARGEST_SHARE = 0.4
"""Of the picture's width or height, that is a margin."""
SOFT_LINES = 2
"""Lines beside a margin that may be a mixture of both."""
FRAMES_WITHIN = 4
"""Margins within margins that are looked for."""


def inner_picture(rgb: NDArray[np.uint8]) -> Window:
    """What of a picture (H, W, 3) lies within its margins, and the line beside them; all of it where there are none."""
    height, width = rgb.shape[:2]
    sides = np.zeros(4, int)  # left, top, right, bottom
    for _ in range(FRAMES_WITHIN):
        left, top, right, bottom = sides
        inner = rgb[top : height - bottom, left : width - right]
        across = inner.transpose(1, 0, 2)
        found = np.array([_margin(side) for side in (across, inner, across[::-1], inner[::-1])])
        sides += np.where(sides + found <= LARGEST_SHARE * np.array([width, height, width, height]), found, 0)
        if not found.any():
            break
    left, top, right, bottom = (int(side) + SOFT_LINES * (side > 0) for side in sides)
    return Window(left, top, width - right, height - bottom)


def _margin(lines: NDArray[np.uint8]) -> int:
    """How many of the first lines (N, L, 3) are a margin."""
    colour = np.median(lines[0], axis=0).astype(np.int16)
    furthest = int(LARGEST_SHARE * len(lines)) + RINGING_LINES
    if (np.abs(lines[0] - colour).max(axis=1) <= PLAIN_LEVELS).mean() < PLAIN_SHARE:
        return 0
    away = np.abs(lines[:furthest] - colour).max(axis=2)
    plain = (away <= PLAIN_LEVELS).mean(axis=1) >= PLAIN_SHARE
    if plain.all():
        return 0
    wide = int(np.argmin(plain))
    near = lines[max(wide - EDGE_PIXELS, 0) : wide + RINGING_LINES + EDGE_PIXELS].astype(np.int16)
    change = np.abs(near[EDGE_PIXELS:] - near[:-EDGE_PIXELS]).max(axis=2)
    ends = (change > EDGE_LEVELS).mean(axis=1) >= FRAME_EDGE_SHARE
    return max(wide - EDGE_PIXELS, 0) + EDGE_PIXELS + int(np.argmax(ends)) if ends.any() else 0
