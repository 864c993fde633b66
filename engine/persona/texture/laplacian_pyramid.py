"""Pictures split into bands of frequencies, and put together again.

Source: P. J. Burt, E. H. Adelson, The Laplacian pyramid as a compact image code, IEEE Transactions on Communications 31, 1983.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray


def levels_of(shape: tuple[int, ...], coarsest: int = 16) -> int:
    """How many levels a picture (H, W, ...) has down to one whose shorter side is less than twice `coarsest` pixels."""
    return max(int(np.log2(min(shape[:2]) / coarsest)), 0) + 1


def laplacian_pyramid(picture: NDArray[np.float32], levels: int) -> list[NDArray[np.float32]]:
    """The bands of a picture (H, W) or (H, W, C), the finest first; the last is what is left, the picture made small."""
    bands = []
    for _ in range(levels - 1):
        small = cv2.pyrDown(picture)
        bands.append(np.asarray(picture - _enlarged(small, picture.shape), np.float32))
        picture = np.asarray(small, np.float32)
    return [*bands, picture]


def collapsed(bands: Sequence[NDArray[np.float32]]) -> NDArray[np.float32]:
    """The picture of its bands: the inverse of `laplacian_pyramid`."""
    picture = bands[-1]
    for band in bands[-2::-1]:
        picture = np.asarray(_enlarged(picture, band.shape) + band, np.float32)
    return picture


def _enlarged(small: NDArray[np.floating] | cv2.typing.MatLike, shape: tuple[int, ...]) -> NDArray[np.float32]:
    return np.asarray(cv2.pyrUp(np.asarray(small, np.float32), dstsize=(shape[1], shape[0])), np.float32)
