"""Skinning weights as engines take them: whole numbers that sum to one exactly, no joint named twice or for nothing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FULL_INFLUENCE = 65535
"""The weight one, as a 16-bit number."""


def quantise_influences(
    bones: NDArray[np.integer], weights: NDArray[np.floating]
) -> tuple[NDArray[np.uint8], NDArray[np.uint16]]:
    """Influences (V, 4) to (V, 4) uint8 joints and (V, 4) uint16 weights out of `FULL_INFLUENCE`, strongest first.

    A joint named twice gets the sum of its weights; joints of weight zero become joint 0; what rounding leaves over
    goes to the strongest. Raises ValueError where a vertex has no weight at all.
    """
    joints = np.asarray(bones, np.int64).copy()
    shares = np.maximum(np.asarray(weights, np.float64), 0)
    for later in range(1, joints.shape[1]):
        for earlier in range(later):
            same = joints[:, later] == joints[:, earlier]
            shares[same, earlier] += shares[same, later]
            shares[same, later] = 0
    total = shares.sum(1, keepdims=True)
    if not (total > 0).all():
        raise ValueError("a vertex hangs on no joint")
    order = np.argsort(-shares, axis=1, kind="stable")
    shares, joints = np.take_along_axis(shares, order, 1), np.take_along_axis(joints, order, 1)
    whole = np.floor(shares / total * FULL_INFLUENCE).astype(np.int64)
    whole[:, 0] += FULL_INFLUENCE - whole.sum(1)
    joints[whole == 0] = 0
    return joints.astype(np.uint8), whole.astype(np.uint16)
