"""A texture at every size, so that a character far away does not shimmer.

Source: L. Williams, Pyramidal parametrics, SIGGRAPH 1983.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray


class Mipmap(NamedTuple):
    """`texels` (N, 3) uint8: all levels one after the other, rows from the top; `starts` (L,) int64 where each begins;
    `sizes` (L, 2) int64 heights and widths, each half of the one before."""

    texels: NDArray[np.uint8]
    starts: NDArray[np.int64]
    sizes: NDArray[np.int64]


def build_mipmap(texture: NDArray[np.uint8], smallest: int = 16) -> Mipmap:
    """The levels of a texture (H, W, 3) uint8, down to `smallest` texels on the shorter side."""
    levels = [np.ascontiguousarray(texture)]
    while min(levels[-1].shape[:2]) >= 2 * smallest:
        height, width = levels[-1].shape[:2]
        levels.append(np.asarray(cv2.resize(levels[-1], (width // 2, height // 2), interpolation=cv2.INTER_AREA)))
    counts = [level.shape[0] * level.shape[1] for level in levels]
    return Mipmap(
        np.concatenate([level.reshape(-1, 3) for level in levels]),
        np.cumsum([0, *counts[:-1]]),
        np.array([level.shape[:2] for level in levels], np.int64),
    )


@njit(cache=True, nogil=True, inline="always", boundscheck=False)
def _bilinear(texels: np.ndarray, start: int, height: int, width: int, u: float, v: float) -> tuple:
    one = np.float32(1)
    x = min(max(u * np.float32(width) - np.float32(0.5), np.float32(0)), np.float32(width - 1))
    y = min(max(v * np.float32(height) - np.float32(0.5), np.float32(0)), np.float32(height - 1))
    left, top = int(x), int(y)
    fx, fy = x - np.float32(left), y - np.float32(top)
    across = 1 if left + 1 < width else 0
    a = start + top * width + left
    b = a + (width if top + 1 < height else 0)
    waa, wab, wba, wbb = (one - fx) * (one - fy), fx * (one - fy), (one - fx) * fy, fx * fy
    red = waa * texels[a, 0] + wab * texels[a + across, 0] + wba * texels[b, 0] + wbb * texels[b + across, 0]
    green = waa * texels[a, 1] + wab * texels[a + across, 1] + wba * texels[b, 1] + wbb * texels[b + across, 1]
    blue = waa * texels[a, 2] + wab * texels[a + across, 2] + wba * texels[b, 2] + wbb * texels[b + across, 2]
    return red, green, blue


@njit(cache=True, nogil=True, inline="always", boundscheck=False)
def look_up(texels: np.ndarray, starts: np.ndarray, sizes: np.ndarray, u: float, v: float, level: float) -> tuple:
    """Red, green and blue (0 to 255) at (u, v), as in glTF: bilinear within a level, linear between two. `level` is
    the binary logarithm of the texels to a pixel."""
    last = len(starts) - 1
    if level <= 0 or last == 0:
        return _bilinear(texels, starts[0], sizes[0, 0], sizes[0, 1], u, v)
    lower = min(int(level), last)
    red, green, blue = _bilinear(texels, starts[lower], sizes[lower, 0], sizes[lower, 1], u, v)
    if lower == last:
        return red, green, blue
    share = np.float32(level - lower)
    upper = lower + 1
    red2, green2, blue2 = _bilinear(texels, starts[upper], sizes[upper, 0], sizes[upper, 1], u, v)
    return red + share * (red2 - red), green + share * (green2 - green), blue + share * (blue2 - blue)
