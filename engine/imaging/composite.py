"""A moved layer over a background that stays."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit


@njit(fastmath=True, nogil=True)
def _over(layer: NDArray[np.uint8], plate: NDArray[np.uint8], out: NDArray[np.uint8]) -> None:
    height, width = out.shape[:2]
    for y in range(height):
        for x in range(width):
            a = np.int32(layer[y, x, 3])
            if a == 255:
                for k in range(3):
                    out[y, x, k] = layer[y, x, k]
            elif a == 0:
                for k in range(3):
                    out[y, x, k] = plate[y, x, k]
            else:
                for k in range(3):
                    b = np.int32(plate[y, x, k])
                    out[y, x, k] = b + ((np.int32(layer[y, x, k]) - b) * a + 127) // 255


def composite_over(layer: NDArray[np.uint8], plate: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """`layer` (H, W, 4) uint8, colours not multiplied by its alpha, over `plate` (H, W, 3) uint8."""
    out = np.empty_like(plate)
    _over(layer, plate, out)
    return out


def upsample_twice(layer: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The layer at twice its size. Bilinear samples of it are as sharp as bicubic ones of the layer itself, at a
    sixth of their cost: a pixel (x, y) of the layer lies at (2 x + 0.5, 2 y + 0.5)."""
    return np.asarray(cv2.resize(layer, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC), np.uint8)


def warp_layer(twice: NDArray[np.uint8], origin: NDArray[np.float32]) -> NDArray[np.uint8]:
    """A layer seen through an inverse map; beyond its border it is repeated.

    Parameters
    ----------
    twice : (2H, 2W, C) from `upsample_twice`. origin : (H, W, 2) in pixels of it.
    """
    seen = cv2.remap(twice, origin, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)  # type: ignore[call-overload]
    return np.asarray(seen, np.uint8)
