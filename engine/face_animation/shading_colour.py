"""The colour of a shadow on skin: light that comes back out of it is redder than what falls on it, so red darkens less.

A ratio image of equation 2 is one of luminance, and a fold that darkens all channels alike is grey on pale skin. In the folds of three
filmed faces the logarithm of red falls 0.62 to 0.77 times as far as that of luminance, green's 1.09 to 1.13 and blue's 1.06 to 1.35 times. The shading
that a picture shows of its own face has the same slopes (red 0.5 to 0.9 in colour photographs and most paintings, one in black and white): they are taken from there.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.luminance import LUMINANCE_WEIGHTS

FLOOR_GREY_LEVELS = 4.0
"""Added to colours before their logarithm, so that the dark has no colour."""
SHADING_BLUR_EYE_DISTANCES = 0.06
"""Standard deviation, eye distances: finer structure is pores and grain."""
MAX_LOG_LUMINANCE_DEVIATION = 0.6
"""Distance from the median within which a pixel is skin, in light or in shade."""
MIN_LOG_LUMINANCE_SPREAD = 0.04
"""Of the logarithm of luminance, standard deviation: skin that is more even than this shows no shading."""
CHANNEL_SLOPE_RANGE = ((0.5, 0.8, 0.8), (1.1, 1.3, 1.6))
"""Least and most of each channel."""
MIN_SHADED_SKIN_PIXELS = 200


def shading_slopes(rgb: NDArray[np.uint8], skin: NDArray[np.floating], unit: float) -> NDArray[np.float32]:
    """(3,) by how much more or less than the logarithm of luminance that of each channel falls where skin is in shade; one where nothing is to be seen of it.

    `rgb` (h, w, 3) with its `skin` (h, w) in [0, 1]; eye distance `unit` pixels.
    """
    soft = cv2.GaussianBlur(rgb.astype(np.float32), (0, 0), max(SHADING_BLUR_EYE_DISTANCES * unit, 0.6))
    colours = np.log(soft[skin > 0.5] + np.float32(FLOOR_GREY_LEVELS))
    if len(colours) < MIN_SHADED_SKIN_PIXELS:
        return np.ones(3, np.float32)
    colours -= np.median(colours, axis=0)
    light = colours @ LUMINANCE_WEIGHTS
    near = np.abs(light) < MAX_LOG_LUMINANCE_DEVIATION
    colours, light = colours[near], light[near]
    if np.sqrt(np.mean(light**2)) < MIN_LOG_LUMINANCE_SPREAD:
        return np.ones(3, np.float32)
    return np.clip((colours * light[:, None]).sum(axis=0) / (light**2).sum(), *CHANNEL_SLOPE_RANGE).astype(np.float32)
