"""Light that goes on from what a picture shows of a surface into what is filled: where both meet no border is seen."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

LIGHT_DOWNSAMPLING, LIGHT_TEXELS, MAX_LIGHT_LEVELS, FULLY_SHOWN = 4, 40.0, 30.0, 0.9
"""How much smaller light is looked at; texels over which it goes on; grey levels of it at most; and how far a texel is shown that says so."""
AVERAGING_TEXELS, FARTHER_WEIGHT = (6.0, 16.0, 40.0), 0.1
"""Texels around over which light is averaged, and how much each of these averages counts beside the nearer one: as little as it can where that knows
anything, so that what is filled meets the border itself and not what is shown behind it."""


def light_of_the_picture(change: NDArray[np.float32], shown: NDArray[np.float32]) -> NDArray[np.float32]:
    """By how much (S, S, 3) what is filled is to be lighter, so that it meets what is `shown` (S, S) as light as that is: the picture's `change` (S, S,
    3) beside it, less and less away from it."""
    size = (shown.shape[1] // LIGHT_DOWNSAMPLING, shown.shape[0] // LIGHT_DOWNSAMPLING)
    sure = (shown > FULLY_SHOWN).astype(np.float32)
    step = np.clip(change, -MAX_LIGHT_LEVELS, MAX_LIGHT_LEVELS) * sure[..., None]
    small, weight = (cv2.resize(one, size, interpolation=cv2.INTER_AREA) for one in (step, sure))
    around, count = (
        sum(FARTHER_WEIGHT**k * cv2.GaussianBlur(one, (0, 0), texels / LIGHT_DOWNSAMPLING)
            for k, texels in enumerate(AVERAGING_TEXELS))
        for one in (small, weight)
    )  # fmt: skip
    away = cv2.distanceTransform((weight < 0.5).astype(np.uint8), cv2.DIST_L2, 5)
    fading = np.exp(-away / np.float32(LIGHT_TEXELS / LIGHT_DOWNSAMPLING))
    light = around / np.maximum(count, 1e-6)[..., None] * fading[..., None]
    return np.asarray(cv2.resize(light, shown.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)
