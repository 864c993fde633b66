"""A small picture's matte at the size of the large one, its edges following the large one's."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.resample import resized

GUIDE_COVARIANCE_REGULARISATION = 1e-4
"""What is added to the variances of colours in [0, 1]: noise of a flat area."""


def upsample_guided(
    matte: NDArray[np.float32], small: NDArray[np.uint8], rgb: NDArray[np.uint8], radius: int = 2
) -> NDArray[np.float32]:
    """The matte (h, w) of a picture `small` (h, w, 3) at the size of `rgb` (H, W, 3).

    Guided filter (He, Sun, Tang, PAMI 2013) in its fast form: the local affine model from colour to
    alpha is fitted on the small picture, over windows of `radius`, and applied to the large one.
    """
    size = (rgb.shape[1], rgb.shape[0])
    slope, offset = _affine_models(small.astype(np.float32) / np.float32(255), matte, radius)
    fine = (resized(slope, size) * rgb).sum(-1) / 255 + resized(offset, size)
    plain = resized(matte, size)
    settled = (plain <= 0) | (plain >= 1)
    return np.where(settled, plain, np.clip(fine, 0, 1)).astype(np.float32)


def _affine_models(
    guide: NDArray[np.float32], alpha: NDArray[np.float32], radius: int
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Slopes (H, W, 3) and offsets (H, W) of alpha as an affine function of the colour around each pixel."""
    side = (2 * radius + 1, 2 * radius + 1)

    def mean(values: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.asarray(cv2.blur(values, side), np.float32)

    colour, level = mean(guide), mean(alpha)
    cross = mean(guide * alpha[..., None]) - colour * level[..., None]
    products = mean(np.stack([guide[..., i] * guide[..., j] for i in range(3) for j in range(3)], -1))
    spread = products.reshape(*alpha.shape, 3, 3) - colour[..., :, None] * colour[..., None, :]
    slope = np.linalg.solve(spread + GUIDE_COVARIANCE_REGULARISATION * np.eye(3, dtype=np.float32), cross[..., None])[
        ..., 0
    ]
    offset = level - np.einsum("ijk,ijk->ij", slope, colour)
    return mean(slope.astype(np.float32)), mean(offset.astype(np.float32))
