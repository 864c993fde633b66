"""What is lighter or darker on a picture's skin, carried to where its warp has that skin."""

from __future__ import annotations

import numpy as np

from engine.compiled import njit


@njit(fastmath=True, nogil=True)
def add_carried(rgb, change, share, origin, per_pixel, left, top, shrink):  # type: ignore[no-untyped-def]
    """Colours with `share` of bilinear samples of `change` added, which lies at (left, top) of the target, `shrink` times as large."""
    rows, columns = change.shape[:2]
    half = np.float32(0.5)
    for y in range(rgb.shape[0]):
        for x in range(rgb.shape[1]):
            u = ((origin[y, x, 0] + half) * per_pixel - left) * shrink - half
            v = ((origin[y, x, 1] + half) * per_pixel - top) * shrink - half
            if not (u >= 0 and v >= 0 and u < columns - 1 and v < rows - 1):
                continue
            i, j = int(v), int(u)
            a, b = v - np.float32(i), u - np.float32(j)
            for c in range(3):
                added = share * _sample(change, i, j, a, b, c)
                if abs(added) >= half:
                    rgb[y, x, c] = np.uint8(min(max(rgb[y, x, c] + added, np.float32(0)), np.float32(254)) + half)


@njit(fastmath=True, nogil=True)
def _sample(image, i, j, a, b, c):  # type: ignore[no-untyped-def]
    above = (1 - b) * image[i, j, c] + b * image[i, j + 1, c]
    below = (1 - b) * image[i + 1, j, c] + b * image[i + 1, j + 1, c]
    return (1 - a) * above + a * below
