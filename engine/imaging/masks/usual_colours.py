"""Which colours of a region are usual in it: what is worn once, as a tie, a badge or a button, is no pattern to go on with."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

BIN_LEVELS = 16
"""Levels (CIE Lab, 8 bits) of a bin of the histogram: those in it are one colour with those beside them."""
RARE_SHARE = 0.04
"""Share of a region below which a colour is rare, those beside it included."""
MIXED_PIXELS = 3
"""Pixels around rare colours in which they are mixed with others."""
MIN_USUAL_SHARE = 0.3
"""Share of a region that must be left; else all of it is usual."""


def usual_colours(rgb: NDArray[np.uint8], region: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a region (h, w) of a picture (h, w, 3) whose colours are not rare in it."""
    if not region.any():
        return region
    bins = cv2.cvtColor(rgb, cv2.COLOR_RGB2LAB)[region] // BIN_LEVELS
    count = np.zeros((256 // BIN_LEVELS,) * 3)
    np.add.at(count, tuple(bins.T), 1)
    near = 27 * uniform_filter(count, 3, mode="constant")
    rare = np.zeros(region.shape, np.uint8)
    rare[region] = near[tuple(bins.T)] < RARE_SHARE * len(bins)
    usual = region & ~(cv2.dilate(rare, np.ones((2 * MIXED_PIXELS + 1, 2 * MIXED_PIXELS + 1), np.uint8)) > 0)
    return usual if usual.sum() > MIN_USUAL_SHARE * region.sum() else region
