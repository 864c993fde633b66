"""A moved layer over a background that stays."""

from __future__ import annotations

import cv2
import numba
import numpy as np
from numpy.typing import NDArray


@numba.njit(cache=True, parallel=True, fastmath=True)
def _over(layer: NDArray[np.uint8], plate: NDArray[np.uint8], out: NDArray[np.uint8]) -> None:
    height, width = out.shape[:2]
    for y in numba.prange(height):
        for x in range(width):
            a = np.int32(layer[y, x, 3])
            for k in range(3):
                b = np.int32(plate[y, x, k])
                out[y, x, k] = b + ((np.int32(layer[y, x, k]) - b) * a + 127) // 255


def over(layer: NDArray[np.uint8], plate: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """`layer` (H, W, 4) uint8, colours not multiplied by its alpha, over `plate` (H, W, 3) uint8."""
    out = np.empty_like(plate)
    _over(layer, plate, out)
    return out


def warp_layer(layer: NDArray[np.uint8], origin: NDArray[np.float32]) -> NDArray[np.uint8]:
    """The layer (H, W, 4) seen through an inverse map `origin` (H, W, 2); beyond its border it is repeated."""
    return np.asarray(
        cv2.remap(layer, origin[..., 0], origin[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE), np.uint8
    )
