"""For each pixel the nearest one of a mask: what is known there stands in for what is not known here."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray


def nearest_in(mask: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns, (H, W) each, of the pixel of a mask (H, W) that is nearest to each pixel; its own within it.

    Distances are those of a 5 x 5 chamfer (Borgefors 1986), 2 % from Euclid's at most: of two pixels that are about as
    near, either may be taken. Of an empty mask all are the first pixel.
    """
    labels = _nearest(mask)
    rows, columns = np.nonzero(mask)
    row_of, column_of = np.zeros((2, int(labels.max()) + 1), np.intp)
    row_of[labels[mask]], column_of[labels[mask]] = rows, columns
    return row_of[labels], column_of[labels]


def nearest_values(values: NDArray[np.generic], known: NDArray[np.bool_]) -> NDArray[Any]:
    """Values (H, W, ...), each outside of `known` (H, W), which is not empty, that of the nearest pixel inside."""
    rows, columns = nearest_in(known)
    return np.asarray(values)[rows, columns]


def nearest_colours(rgb: NDArray[np.uint8], own: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """The picture with each pixel outside of `own`, which is not empty, in the colour of the nearest one inside.

    As `nearest_in` has it, in a third of its memory: pictures can have 40 megapixels.
    """
    labels = _nearest(own)
    colour_of = np.zeros((int(labels.max()) + 1, 3), np.uint8)
    colour_of[labels[own]] = rgb[own]
    return colour_of[labels]


def _nearest(mask: NDArray[np.bool_]) -> NDArray[np.int32]:
    """(H, W) numbers of the pixels of a mask, and outside of it of the nearest one."""
    outside = (~mask).astype(np.uint8)
    labels = cv2.distanceTransformWithLabels(outside, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)[1]
    return np.asarray(labels, np.int32)


def continued_colours(rgb: NDArray[np.uint8], own: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """The picture with each pixel outside of `own` in the colour of the nearest one inside, softly."""
    if not own.any() or own.all():
        return rgb
    soft = np.asarray(cv2.GaussianBlur(nearest_colours(rgb, own), (0, 0), 2.0))
    return np.where(own[..., None], rgb, soft).astype(np.uint8)
