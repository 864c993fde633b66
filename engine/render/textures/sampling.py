"""Colours of a picture at places between its pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


def bilinear(picture: NDArray, pixels: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N, C) float32 of a picture (H, W, C) at pixels (N, 2 or more), x and y first, the centre of the upper left one at
    (0, 0). Beyond its border it goes on as its outermost pixels; where a place is not finite, the first pixel."""
    return np.asarray(_bilinear(np.ascontiguousarray(picture), np.ascontiguousarray(pixels)))


@njit(nogil=True, boundscheck=False, error_model="numpy")
def _bilinear(picture: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    height, width, channels = picture.shape
    out = np.empty((len(pixels), channels), np.float32)
    for n in range(len(pixels)):
        x = min(max(pixels[n, 0], 0.0), width - 1.0)
        y = min(max(pixels[n, 1], 0.0), height - 1.0)
        if not (x >= 0 and y >= 0):
            x, y = 0.0, 0.0
        left, top = int(x), int(y)
        right, bottom = min(left + 1, width - 1), min(top + 1, height - 1)
        fx, fy = np.float32(x - left), np.float32(y - top)
        for k in range(channels):
            upper = picture[top, left, k] * (1 - fx) + picture[top, right, k] * fx
            lower = picture[bottom, left, k] * (1 - fx) + picture[bottom, right, k] * fx
            out[n, k] = upper * (1 - fy) + lower * fy
    return out
