"""Values of pixels that spread within a mask and never across a gap in it."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.masks.mask_pieces import bounding_box


def diffuse(values: NDArray[np.float32], mask: NDArray[np.bool_], rounds: int) -> NDArray[np.float32]:
    """`values` (N, C) of the N pixels of `mask` (H, W), in their order, each replaced `rounds` times by the mean of
    itself and its neighbours (of eight) in the mask. On open ground that is a blur with a standard deviation of sqrt(2
    / 3 rounds) pixels."""
    if not len(values):
        return values.copy()
    mask = mask[bounding_box(mask)]
    (height, width), channels = mask.shape, values.shape[1]
    planes = np.zeros(
        (channels, height, width + 2), np.float32
    )  # a column more at either side; 0 where the mask is not
    planes[:, :, 1:-1][:, mask] = values.T
    met = cv2.boxFilter(mask.astype(np.float32), -1, (3, 3), normalize=False, borderType=cv2.BORDER_CONSTANT)
    share = np.where(mask, 1 / np.maximum(met, 1), 0).astype(np.float32)
    _diffuse(planes, share, rounds)
    return np.ascontiguousarray(planes[:, :, 1:-1][:, mask].T)


@njit(nogil=True, fastmath=True, boundscheck=False, error_model="numpy")
def _diffuse(planes, share, rounds):  # type: ignore[no-untyped-def]
    """In place, plane by plane, each of which a processor's cache holds: sums along the rows, of which three are kept as they
    were, and then down the columns."""
    height, width = share.shape
    sums = np.zeros((3, width), np.float32)
    for c in range(len(planes)):
        plane = planes[c]
        for _ in range(rounds):
            sums[:] = 0
            for y in range(-1, height):
                above, here, below = sums[(y + 2) % 3], sums[(y + 3) % 3], sums[(y + 1) % 3]
                for x in range(width):
                    below[x] = plane[y + 1, x] + plane[y + 1, x + 1] + plane[y + 1, x + 2] if y + 1 < height else 0
                if y >= 0:
                    for x in range(width):
                        plane[y, x + 1] = share[y, x] * (above[x] + here[x] + below[x])
