"""Pictures at another size, averaged when they shrink."""

from __future__ import annotations

from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

Pixel = TypeVar("Pixel", np.uint8, np.float32)


def resized(image: NDArray[Pixel], size: tuple[int, int], smooth: bool = True) -> NDArray[Pixel]:
    """`image` (H, W) or (H, W, C) at `size` = (width, height) pixels, same type and number of axes.

    Pixels are averaged over their area where the picture shrinks; where it grows they are interpolated
    linearly, or repeated if not `smooth`.
    """
    width, height = size
    if (height, width) == image.shape[:2]:
        return image
    if height <= image.shape[0] and width <= image.shape[1]:
        method = cv2.INTER_AREA
    else:
        method = cv2.INTER_LINEAR if smooth else cv2.INTER_NEAREST
    result = cv2.resize(image, (width, height), interpolation=method)
    return np.asarray(result, image.dtype).reshape(height, width, *image.shape[2:])


def size_within(shape: tuple[int, ...], longest: int) -> tuple[int, int]:
    """The (width, height) of a picture of `shape` (H, W, ...) shrunk so that no side exceeds `longest`."""
    height, width = shape[:2]
    scale = min(1.0, longest / max(height, width))
    return max(1, round(width * scale)), max(1, round(height * scale))


def even_size(width: float, height: float) -> tuple[int, int]:
    """The nearest even width and height (at least 2), as 4:2:0 video wants them."""
    return max(2, 2 * round(width / 2)), max(2, 2 * round(height / 2))


def enlarged_mask(mask: NDArray[np.bool_], size: tuple[int, int]) -> NDArray[np.bool_]:
    """A mask (H, W) at `size` = (width, height): its edge runs between the pixels."""
    return np.asarray(cv2.resize(mask.astype(np.float32), size, interpolation=cv2.INTER_LINEAR)) > 0.5
