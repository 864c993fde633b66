"""Photographs exposed and balanced alike, so that what they share is not their cameras' tone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MAX_CHANNEL_GAIN = 2.5
"""Of a channel, either way: what asks for more is another light, or no colour at all."""
GREY_CHROMA_LEVELS = 2.0
"""Grey levels that the mean chroma of a photograph in black and white differs from grey, at most."""


def is_grey(colours: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """(N,) which of photographs (N, H, W, 3) are in black and white."""
    spread = np.ptp(colours[:, ::4, ::4].astype(np.int16), axis=-1)
    return np.asarray(spread.mean(axis=(1, 2)) < GREY_CHROMA_LEVELS)


def balanced(colours: NDArray[np.uint8], belief: NDArray[np.floating], face: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """(N, H, W, 3) the photographs, each channel scaled so that its mean over what can be believed of the `face` (H, W) is that of all:
    the median of the means of photographs in colour. One in black and white takes its tone, too: it is tinted as skin is.

    belief : (N, H, W) in [0, 1].
    """
    weights = np.asarray(belief[:, face], np.float32) + np.float32(1e-3)
    means = np.array([weight @ photo[face] / weight.sum() for weight, photo in zip(weights, colours, strict=True)])
    coloured = ~is_grey(colours)
    common = np.median(means[coloured] if coloured.any() else means, axis=0)
    gains = np.clip(common / np.maximum(means, 1), 1 / MAX_CHANNEL_GAIN, MAX_CHANNEL_GAIN).astype(np.float32)
    out = np.empty_like(colours)
    for photo, gain, target in zip(colours, gains, out, strict=True):
        target[:] = np.clip(np.rint(photo * gain), 0, 255)
    return out
