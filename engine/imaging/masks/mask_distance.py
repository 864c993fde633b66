"""Distances from a mask's edge and from lines, and masks that have grown by some."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray


def distance_inside(mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """How far each pixel of a mask (H, W) is from what is outside, pixels; beyond the picture is outside. 0 beside the mask."""
    padded = cv2.distanceTransform(np.pad(mask.astype(np.uint8), 1), cv2.DIST_L2, 5)
    return np.asarray(padded, np.float32)[1:-1, 1:-1]


def distance_to(mask: NDArray[np.bool_]) -> NDArray[np.float32]:
    """How far each pixel is from a mask (H, W), pixels; 0 within. Where the mask is empty, further than anything."""
    return np.asarray(cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5), np.float32)


def dilate_mask(mask: NDArray[np.bool_], pixels: int) -> NDArray[np.bool_]:
    """A mask (H, W) and what is beside it, up to so many pixels in each direction."""
    return np.asarray(cv2.dilate(mask.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=pixels) > 0)


def near_lines(shape: tuple[int, ...], lines: NDArray[np.floating], radius: float) -> NDArray[np.bool_]:
    """(h, w) of `shape`: the pixels within so many of lines (L, 2, 2), each by both its ends, x and y; half a pixel at least."""
    drawn = np.zeros(shape, np.uint8)
    for first, second in np.rint(lines).astype(int).tolist():
        cv2.line(drawn, first, second, (1,), 1)
    return np.asarray(distance_to(drawn > 0) <= max(radius, 0.5))
