"""Pictures of which parts are known, continued smoothly everywhere: averages of what is near, the farther off the wider.

Source: S. J. Gortler, R. Grzeszczuk, R. Szeliski, M. F. Cohen, The Lumigraph, SIGGRAPH 1996, section 3.6.2 (pull, push).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

FULL_PIXEL_WEIGHT = 0.5
"""Of a pixel, from which on it is itself alone."""
MIN_COARSE_SIDE_PIXELS = 2
"""Pixels of the coarsest level's shorter side, at least."""


def pull_push(picture: NDArray[np.floating], weight: NDArray[np.floating]) -> NDArray[np.float32]:
    """(H, W, C) float32 a picture (H, W, C) where its `weight` (H, W), in [0, 1], is `FULL_PIXEL_WEIGHT` and more; what is about it elsewhere, mixed
    in between. Where nothing has a weight, zero."""
    known = np.asarray(weight, np.float32)[..., None]
    return _continued(np.asarray(picture, np.float32) * known, known)


def _continued(mixed: NDArray[np.float32], known: NDArray[np.float32]) -> NDArray[np.float32]:
    own = mixed / np.maximum(known, 1e-6)
    if min(mixed.shape[:2]) < 2 * MIN_COARSE_SIDE_PIXELS:
        total = np.float32(known.sum())
        mean = mixed.sum(axis=(0, 1)) / max(total, np.float32(1e-6))
        coarse = np.broadcast_to(mean, mixed.shape)
    else:
        pulled, weight = _halved(mixed), _halved(known)
        grown = np.minimum(weight / FULL_PIXEL_WEIGHT, 1) / np.maximum(
            weight, 1e-6
        )  # what little is known here is all that is known
        below = _continued(pulled * grown, weight * grown)
        coarse = _as_coloured(cv2.pyrUp(below, dstsize=(mixed.shape[1], mixed.shape[0])), mixed.shape)
    share = np.minimum(known / FULL_PIXEL_WEIGHT, 1)
    return np.asarray(share * own + (1 - share) * coarse, np.float32)


def _halved(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    height, width, channels = picture.shape
    return _as_coloured(cv2.pyrDown(picture), ((height + 1) // 2, (width + 1) // 2, channels))


def _as_coloured(picture: cv2.typing.MatLike, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """With its channels' axis, which is lost where there is one channel."""
    return np.asarray(picture, np.float32).reshape(shape)
