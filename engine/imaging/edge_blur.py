"""How sharp a picture is: the blur of its sharpest edges.

An edge that is blurred once more loses the less of its slope the softer it is already, which gives the width of its blur
(S. Zhuo and T. Sim, Defocus map estimation from a single image, Pattern Recognition 44, 2011, equations 4 to 6).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

REBLUR_SIGMA_PIXELS = 1.0
"""Pixels, the standard deviation of the blur that is added."""
EDGE_SLOPE_SHARE, MIN_SLOPE = 0.35, 2.0
"""Of the steepest slope in what is looked at, from which on there is an edge, and not grain; and grey levels a pixel that it has at least."""
SHARP_PERCENTILE = 30
"""Of the edges' blurs: the sharper ones say how sharp the picture is, the others are soft in themselves."""
MAX_BLUR_PIXELS = 4.0
"""Pixels that are told, at most."""
OWN_BLUR_PIXELS = 0.5
"""Pixels, of slopes taken over two pixels, and of the pixels themselves."""
MIN_EDGES = 12


def edge_blur(grey: NDArray[np.number], mask: NDArray[np.bool_]) -> float | None:
    """The standard deviation in pixels, as of a Gaussian, by which the sharper edges of a picture (H, W) are blurred where
    the `mask` (H, W) is; None where it shows no edges."""
    picture = np.asarray(grey, np.float32)
    slope, softer = (
        _slope(picture),
        _slope(np.asarray(cv2.GaussianBlur(picture, (0, 0), REBLUR_SIGMA_PIXELS), np.float32)),
    )
    least = max(MIN_SLOPE, EDGE_SLOPE_SHARE * float(softer[mask].max(initial=0)))
    found = mask & (softer > least) & (softer >= cv2.dilate(softer, np.ones((3, 3), np.uint8)))
    if found.sum() < MIN_EDGES:
        return None
    ratio = slope[found] / np.maximum(softer[found], 1e-3)
    blur = REBLUR_SIGMA_PIXELS / np.sqrt(np.maximum(ratio**2 - 1, (REBLUR_SIGMA_PIXELS / MAX_BLUR_PIXELS) ** 2))
    return float(np.sqrt(max(float(np.percentile(blur, SHARP_PERCENTILE)) ** 2 - OWN_BLUR_PIXELS**2, 0.0)))


def _slope(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W) grey levels a pixel."""
    across, down = np.gradient(picture)
    return np.asarray(np.hypot(across, down), np.float32)
