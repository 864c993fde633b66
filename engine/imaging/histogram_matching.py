"""Colours brought to the distribution of others, in CIELAB, where steps of equal size look alike.

Source: the histogram matching of R. Gonzalez, R. Woods, Digital Image Processing, section 3.3, channel by channel in CIELAB.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

QUANTILE_COUNT = 65
"""At which two distributions are compared; between them the map is linear."""
IGNORED_TAIL_SHARE = 0.02
"""Share of the reference at either end that is not followed: highlights, and what is not of it."""

MIN_RANGE = 2.0
"""Of a channel of CIELAB, below which the colours have no distribution of their own that could be stretched: it is shifted."""


def matched_in_lab(colours: NDArray[np.floating], reference: NDArray[np.floating]) -> NDArray[np.float32]:
    """The colours (N, 3) sRGB, 0 to 255, so that L, a and b are each distributed as those of the `reference` (M, 3). Their
    order stays. Where there is no reference they stay as they are."""
    if not len(colours) or not len(reference):
        return np.asarray(colours, np.float32)
    own, goal = to_lab(colours), to_lab(reference)
    steps = np.linspace(0, 1, QUANTILE_COUNT)
    out = np.empty_like(own)
    for channel in range(3):
        have = np.quantile(own[:, channel], steps)
        want = np.quantile(goal[:, channel], IGNORED_TAIL_SHARE + (1 - 2 * IGNORED_TAIL_SHARE) * steps)
        if np.ptp(have) < MIN_RANGE:
            out[:, channel] = own[:, channel] + np.median(want) - np.median(have)
        else:
            rising = np.concatenate([[True], np.diff(have) > 0])
            out[:, channel] = np.interp(own[:, channel], have[rising], want[rising])
    return from_lab(out)


def to_lab(colours: NDArray[np.number]) -> NDArray[np.float32]:
    """CIELAB (N, 3), D65, of sRGB (N, 3), 0 to 255."""
    rows = np.asarray(colours, np.float32).reshape(-1, 1, 3) / 255
    return np.asarray(cv2.cvtColor(rows, cv2.COLOR_RGB2LAB), np.float32)[:, 0]


def from_lab(lab: NDArray[np.floating]) -> NDArray[np.float32]:
    """sRGB (N, 3), 0 to 255, of CIELAB (N, 3), D65; what sRGB does not have is clipped."""
    rows = np.asarray(lab, np.float32).reshape(-1, 1, 3)
    return np.clip(np.asarray(cv2.cvtColor(rows, cv2.COLOR_LAB2RGB), np.float32)[:, 0] * 255, 0, 255)
