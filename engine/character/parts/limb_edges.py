"""Where a limb's edge is in the picture: labels know it to a pixel of the grid, which is several of the picture's."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.masks.mask_distance import dilate_mask

EDGE_TOLERANCE_SHARE = 0.004
"""How far a limb's edge may lie from that of its label, as a share of the person's height."""
MIN_LIMB_EDGE_CONTRAST_LEVELS = 12.0
"""Levels by which colours differ on two sides of an edge, at least."""

LIMB_EDGE_BAND_PIXELS = 3
"""Pixels of the grid around the rest of the person within which a limb ends where its colours do, and not where the mask does."""


def border(limb: NDArray[np.bool_], person: NDArray[np.bool_], rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    """How far each pixel (h, w) of the grid is a `limb`'s (h, w), by the pixels of the picture (H, W, 3) on a finer one; 1 where none
    of the rest of the `person` (h, w) is near."""
    size = (limb.shape[1], limb.shape[0])
    soft = np.asarray(cv2.resize(soft_limbs(limb, rgb), size, interpolation=cv2.INTER_AREA), np.float32)
    return np.where(dilate_mask(person & ~limb, LIMB_EDGE_BAND_PIXELS), soft, 1).astype(np.float32)


def soft_limbs(limbs: NDArray[np.bool_], rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    """How far each pixel (H, W) of a picture (H, W, 3) is the `limbs`' (h, w) of the grid, in [0, 1], up to the edges that it has
    near theirs. By a guided filter (K. He, J. Sun, X. Tang, ECCV 2010)."""
    size = (rgb.shape[1], rgb.shape[0])
    large = np.asarray(cv2.resize(limbs.astype(np.float32), size, interpolation=cv2.INTER_LINEAR))
    reach = max(2, round(EDGE_TOLERANCE_SHARE * size[1]))
    likely = cv2.ximgproc.guidedFilter(rgb, large, reach, MIN_LIMB_EDGE_CONTRAST_LEVELS**2)
    close = cv2.dilate((large > 0.5).astype(np.uint8), np.ones((3, 3), np.uint8), iterations=reach)
    return np.where(close > 0, np.clip(likely, 0, 1), 0).astype(np.float32)
