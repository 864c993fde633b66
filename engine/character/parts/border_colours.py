"""What the colour of a pixel beside a border of two parts says: that it is of the one, of the other, or of neither.

Each pixel near a border is compared with colours of the insides of both parts around it, where neither is mixed with
the other.
"""

from __future__ import annotations

import cv2
import numpy as np
from numba import prange
from numpy.typing import NDArray

from engine.compiled import njit
from engine.imaging.masks.mask_distance import distance_inside, distance_to

OWN, LIKE_THE_OTHER, LIKE_NEITHER, UNLIKE_BOTH = 0, 1, 2, 3
"""What is said of a pixel's colour. What is unlike both and no mixture may be a print, or light on an edge."""
BAND_PIXELS, BAND_THICKNESS_SHARE = 8.0, 0.45
"""How far from another part a pixel is looked at: pixels of the grid, and as a share of half of the part's own thickness there, whichever is less."""
LIMB_CORE_SHARE = 0.5
"""Share of the way from its border to its middle from which on a part is surely itself."""
THICKNESS_WINDOW_PIXELS = 21
"""Pixels of the window in which a part's thickness is taken."""
COLOUR_SEARCH_RADIUS_PIXELS, COLOUR_SEARCH_STEP_PIXELS = 16, 2
"""How far around a pixel its part is looked at for a colour like its own, and every how many pixels."""
MAX_COLOUR_DISTANCE = 12.0
"""CIE Lab distance up to which two colours are alike."""
MIN_ALIKE_SHARE = 0.05
"""Share of its part's inside around it that has a pixel's colour, at least."""
MIN_SHADOW_DEPTH, MIN_MIXED_SHARE = 6.0, 0.25
"""CIE lightness by which a shadow is darker than its part's darkest; share of another's colour in a mixture that is no more its part's."""
SMOOTHING_SIGMA_PIXELS = 0.8
"""Pixels over which colours are smoothed before they are compared."""


def smoothed_lab(rgb: NDArray[np.uint8]) -> NDArray[np.float32]:
    """The colours (h, w, 3) of a picture (h, w, 3) as they are compared: CIE Lab, smoothed."""
    smooth = cv2.GaussianBlur(rgb, (0, 0), SMOOTHING_SIGMA_PIXELS).astype(np.float32) / 255
    return np.asarray(cv2.cvtColor(smooth, cv2.COLOR_RGB2LAB), np.float32)


def pixels_beside(own: NDArray[np.bool_], others: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a part, its `own` (h, w), that are so near to `others` (h, w) that they may be theirs."""
    if not own.any() or not others.any():
        return np.zeros_like(own)
    window = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THICKNESS_WINDOW_PIXELS, THICKNESS_WINDOW_PIXELS))
    half = cv2.dilate(distance_inside(own), window)
    return np.asarray(own & (distance_to(others) <= np.minimum(BAND_PIXELS, BAND_THICKNESS_SHARE * half)))


def core_of(own: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels (h, w) of a part, its `own` (h, w), that are its whatever border is drawn amiss: half of its thickness, in the middle."""
    window = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THICKNESS_WINDOW_PIXELS, THICKNESS_WINDOW_PIXELS))
    depth = distance_inside(own)
    return np.asarray(own & (depth > LIMB_CORE_SHARE * cv2.dilate(depth, window)))


@njit(parallel=True, boundscheck=False, error_model="numpy")
def judged_colours(lab: np.ndarray, asked: np.ndarray, inside: np.ndarray, beyond: np.ndarray) -> np.ndarray:
    """What the colours `lab` (h, w, 3) of the pixels `asked` (h, w) for are: `OWN`, as what is `inside` (h, w) their part;
    `LIKE_THE_OTHER`, as what is `beyond` (h, w); `LIKE_NEITHER`, a mixture of both, or darker than all; `UNLIKE_BOTH`. (h, w) uint8."""
    height, width = asked.shape
    found = np.zeros((height, width), np.uint8)
    for y in prange(height):
        for x in range(width):
            if not asked[y, x]:
                continue
            own, own_alike, own_darker, other, other_alike = 0, 0, 0, 0, 0
            own_mean, other_mean = np.zeros(3, np.float32), np.zeros(3, np.float32)
            for v in range(
                max(y - COLOUR_SEARCH_RADIUS_PIXELS, 0),
                min(y + COLOUR_SEARCH_RADIUS_PIXELS + 1, height),
                COLOUR_SEARCH_STEP_PIXELS,
            ):
                for u in range(
                    max(x - COLOUR_SEARCH_RADIUS_PIXELS, 0),
                    min(x + COLOUR_SEARCH_RADIUS_PIXELS + 1, width),
                    COLOUR_SEARCH_STEP_PIXELS,
                ):
                    if not (inside[v, u] or beyond[v, u]):
                        continue
                    apart = np.float32(0)
                    for k in range(3):
                        apart += (lab[y, x, k] - lab[v, u, k]) ** 2
                    if inside[v, u]:
                        own += 1
                        own_alike += int(apart < MAX_COLOUR_DISTANCE**2)
                        own_darker += int(lab[v, u, 0] < lab[y, x, 0] + MIN_SHADOW_DEPTH)
                        for k in range(3):
                            own_mean[k] += lab[v, u, k]
                    else:
                        other += 1
                        other_alike += int(apart < MAX_COLOUR_DISTANCE**2)
                        for k in range(3):
                            other_mean[k] += lab[v, u, k]
            if own_alike >= MIN_ALIKE_SHARE * own or other == 0:
                continue
            between, length = np.float32(0), np.float32(1e-6)
            for k in range(3):
                own_mean[k] /= own
                other_mean[k] = other_mean[k] / other - own_mean[k]
                between += (lab[y, x, k] - own_mean[k]) * other_mean[k]
                length += other_mean[k] ** 2
            share = min(max(between / length, np.float32(0)), np.float32(1))
            off = np.float32(0)
            for k in range(3):
                off += (lab[y, x, k] - own_mean[k] - share * other_mean[k]) ** 2
            if other_alike >= MIN_ALIKE_SHARE * other:
                found[y, x] = LIKE_THE_OTHER
            elif own_darker <= MIN_ALIKE_SHARE * own or (off < MAX_COLOUR_DISTANCE**2 and share > MIN_MIXED_SHARE):
                found[y, x] = LIKE_NEITHER
            else:
                found[y, x] = UNLIKE_BOTH
    return found
