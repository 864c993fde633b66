"""A texture at every size, so that a character far away does not shimmer.

Source: L. Williams, Pyramidal parametrics, SIGGRAPH 1983.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


class Mipmap(NamedTuple):
    """A texture's L levels, each half as high and wide as the one before.

    texels : (N,) uint32, all levels one after the other, rows from the top, each texel red, green and blue from the lowest
        byte.
    starts : (L,) int64, where each level begins.
    sizes : (L, 2) int64, heights and widths.
    """

    texels: NDArray[np.uint32]
    starts: NDArray[np.int64]
    sizes: NDArray[np.int64]


def build_mipmap(texture: NDArray[np.uint8], smallest: int = 16) -> Mipmap:
    """The levels of a texture (H, W, 3) uint8, down to `smallest` texels on the shorter side."""
    levels = [np.ascontiguousarray(texture)]
    while min(levels[-1].shape[:2]) >= 2 * smallest:
        height, width = levels[-1].shape[:2]
        levels.append(np.asarray(cv2.resize(levels[-1], (width // 2, height // 2), interpolation=cv2.INTER_AREA)))
    counts = [level.shape[0] * level.shape[1] for level in levels]
    bytes_ = np.zeros((sum(counts), 4), np.uint8)
    bytes_[:, :3] = np.concatenate([level.reshape(-1, 3) for level in levels])
    return Mipmap(
        bytes_.view("<u4")[:, 0].astype(np.uint32),
        np.cumsum([0, *counts[:-1]]),
        np.array([level.shape[:2] for level in levels], np.int64),
    )


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy", forceinline=True)
def _spread(texel: np.uint32) -> np.uint64:
    """The bytes 0, 2, 1, 3 of a texel in the four 16-bit lanes of an integer: weights that sum to 256 can then be
    multiplied into all of them at once, without a carry from one into the next."""
    wide = np.uint64(texel)
    return (wide | (wide << np.uint64(24))) & np.uint64(0x00FF00FF00FF00FF)


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy", forceinline=True)
def _bilinear(texels: np.ndarray, start: int, height: int, width: int, u: np.float32, v: np.float32) -> tuple:
    """Places and weights are rounded to 1/256: at most half a grey level."""
    half, step = np.float32(0.5), np.float32(256)
    x = np.int64(min(max((u * np.float32(width) - half) * step + half, np.float32(0)), np.float32(width - 1) * step))
    y = np.int64(min(max((v * np.float32(height) - half) * step + half, np.float32(0)), np.float32(height - 1) * step))
    left, top, fx, fy = x >> 8, y >> 8, x & 255, y & 255
    a = np.uint64(start + top * width + left)
    across = np.uint64(1 if left + 1 < width else 0)
    b = a + np.uint64(width if top + 1 < height else 0)
    both = (fx * fy + 128) >> 8
    lanes = np.uint64(256 - fx - fy + both) * _spread(texels[a]) + np.uint64(fx - both) * _spread(texels[a + across])
    lanes += np.uint64(fy - both) * _spread(texels[b]) + np.uint64(both) * _spread(texels[b + across])
    low, scale = np.uint64(0xFFFF), np.float32(1 / 256)
    red = np.float32(np.int64(lanes & low)) * scale
    green = np.float32(np.int64((lanes >> np.uint64(32)) & low)) * scale
    blue = np.float32(np.int64((lanes >> np.uint64(16)) & low)) * scale
    return red, green, blue


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy", forceinline=True)
def look_up(
    texels: np.ndarray, starts: np.ndarray, sizes: np.ndarray, u: np.float32, v: np.float32, level: np.float32
) -> tuple:
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
