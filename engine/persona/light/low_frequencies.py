"""Light on a face: the low frequencies of its texture, told at few pixels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

GRID_STEP_PIXELS = 6
"""Pixels of the texture for one at which its light is told."""
LIGHT_SIGMA_EYE_DISTANCES = 0.3
"""Eye distances: what is coarser is light."""
MIN_WEIGHT = 0.01
"""Of the weight of pixels that do not count, so that light goes on where none does."""


def low_frequencies(
    texture: NDArray[np.float32], mask: NDArray[np.floating], eye_distance: float
) -> NDArray[np.float32]:
    """(H, W, 3) those of a texture (H, W, 3) with eyes `eye_distance` pixels apart, told where `mask` (H, W) counts."""
    height, width = texture.shape[:2]
    size = max(width // GRID_STEP_PIXELS, 1), max(height // GRID_STEP_PIXELS, 1)
    sigma = LIGHT_SIGMA_EYE_DISTANCES * eye_distance * size[0] / width
    weights = np.asarray(mask + MIN_WEIGHT, np.float32)
    weighted = cv2.resize(texture * weights[..., None], size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(weights, size, interpolation=cv2.INTER_AREA)
    smooth = np.asarray(
        cv2.GaussianBlur(weighted, (0, 0), sigma) / cv2.GaussianBlur(total, (0, 0), sigma)[..., None], np.float32
    )
    return np.asarray(cv2.resize(smooth, (width, height), interpolation=cv2.INTER_LINEAR), np.float32)
