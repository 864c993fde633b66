"""How blurred a picture is, from the picture alone."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

REBLUR_PIXELS = 9
"""By which a picture is blurred once more, to see how much there was to lose (the value of the paper below)."""


def blur_effect(grey: NDArray[np.uint8]) -> float:
    """How blurred a grey picture (H, W) is, in [0, 1]: the share of its changes from pixel to pixel that it keeps when it is
    blurred once more. A sharp picture has 0.3 to 0.4; a plain one, in which nothing changes, counts as blurred.

    Source: F. Crete, T. Dolmiere, P. Ladret, M. Nicolas, The blur effect, SPIE 6492, 2007.
    """
    picture = grey.astype(np.float32)
    kept = []
    for axis, kernel in ((0, (1, REBLUR_PIXELS)), (1, (REBLUR_PIXELS, 1))):
        changes = np.abs(np.diff(picture, axis=axis))
        remaining = np.abs(np.diff(cv2.blur(picture, kernel), axis=axis))
        total = float(changes.sum())
        kept.append(1.0 if total == 0 else 1 - float(np.maximum(changes - remaining, 0).sum()) / total)
    return max(kept)
