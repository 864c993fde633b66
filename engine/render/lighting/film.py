"""From light to a picture: supersampled radiance to sRGB bytes, as a camera would render it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def box_downsample(picture: NDArray[np.float32], factor: int) -> NDArray[np.float32]:
    """Mean of each `factor` by `factor` block of an (H, W, ...) picture."""
    height, width = picture.shape[0] // factor, picture.shape[1] // factor
    return picture.reshape(height, factor, width, factor, *picture.shape[2:]).mean((1, 3))


def develop(radiance: NDArray[np.float32], exposure: float, shoulder: float = 0.65) -> NDArray[np.uint8]:
    """(H, W, 3) linear radiance to uint8 sRGB: straight up to `shoulder`, above it rolled off to white, so that
    highlights do not burn out."""
    x = radiance * exposure
    over = np.maximum(x - shoulder, 0)
    room = 1 - shoulder
    x = np.where(x > shoulder, shoulder + room * over / (over + room), np.maximum(x, 0))
    encoded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-8) ** (1 / 2.4) - 0.055)
    return np.rint(np.clip(encoded, 0, 1) * 255).astype(np.uint8)
