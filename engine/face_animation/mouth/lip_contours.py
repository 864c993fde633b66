"""The lips' contours, and parts of a picture that they bound."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

UPPER_INNER_LIP = (78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308)
LOWER_INNER_LIP = (78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308)
"""Facing vertices of the inner lips from corner to corner."""
MIN_TEETH_OPENING = 0.08
"""Opening of a mouth, its gap over its width, from which its picture may show teeth."""


def box_around(points: NDArray[np.float32], shape: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """x0, y0, x1, y1 around points (P, 2) within a picture of `shape`; None where hardly any of it is left."""
    low, high = np.floor(points.min(axis=0)).astype(int) - 2, np.ceil(points.max(axis=0)).astype(int) + 3
    x0, y0 = np.maximum(low, 0)
    x1, y1 = min(int(high[0]), shape[1]), min(int(high[1]), shape[0])
    return (int(x0), int(y0), x1, y1) if x1 - x0 > 4 and y1 - y0 > 4 else None


def soft_polygon(points: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """Coverage [0, 1] of a polygon, anti-aliased."""
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(points * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    return mask.astype(np.float32) / np.float32(255)
