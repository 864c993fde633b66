"""Features of a picture: places that are found again in another picture of the same thing, and what they look like.

Source: D. Lowe, Distinctive Image Features from Scale-Invariant Keypoints, IJCV 2004 (OpenCV's implementation), with the
descriptors of R. Arandjelovic, A. Zisserman, Three things everyone should know to improve object retrieval, CVPR 2012.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

DESCRIPTOR_LENGTH = 128
MIN_CONTRAST = 0.006
"""Contrast of an extremum between scales, times the layers of an octave, from which it counts (OpenCV's unit; what others
call a peak threshold of 0.002). Lowe's 0.04 leaves plain cloth without features."""
SCALES_PER_OCTAVE = 3
"""Scales in each octave (Lowe's value)."""
MAX_EDGE_RATIO = 10.0
"""Of the two curvatures at a feature (Lowe's value): beyond, it may slide along an edge."""


@dataclass(frozen=True)
class Features:
    """F features of one picture.

    pixels : (F, 2) float32.
    sizes : (F,) float32, diameters in pixels.
    descriptors : (F, 128) float32, unit vectors with no component below zero.
    """

    pixels: NDArray[np.float32]
    sizes: NDArray[np.float32]
    descriptors: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.pixels)

    def __getitem__(self, chosen: NDArray[np.integer] | NDArray[np.bool_]) -> Features:
        """Those that an index array or a mask (F,) chooses."""
        return Features(self.pixels[chosen], self.sizes[chosen], self.descriptors[chosen])


def find_features(
    rgb: NDArray[np.uint8], count: int, favoured: NDArray[np.bool_] | None = None, min_contrast: float = MIN_CONTRAST
) -> Features:
    """The features with most contrast, at most `count`.

    Parameters
    ----------
    rgb : (H, W, 3).
    favoured : (H, W), where half of them are taken from, if there are so many.
    """
    sift = cv2.SIFT_create(0, SCALES_PER_OCTAVE, min_contrast, MAX_EDGE_RATIO, 1.6, True)  # type: ignore[attr-defined]
    grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
    found = sorted(sift.detect(grey, None), key=lambda one: -one.response)
    if favoured is not None and len(found) > count:
        found = _shared_out(found, count, favoured)
    found, described = sift.compute(grey, found[:count])
    if described is None or not len(found):
        return Features(
            np.zeros((0, 2), np.float32), np.zeros(0, np.float32), np.zeros((0, DESCRIPTOR_LENGTH), np.float32)
        )
    rooted = np.sqrt(described / np.maximum(described.sum(axis=1, keepdims=True), 1e-9))
    pixels = np.array([one.pt for one in found], np.float32)
    return Features(pixels, np.array([one.size for one in found], np.float32), rooted.astype(np.float32))


def _shared_out(found: list[cv2.KeyPoint], count: int, favoured: NDArray[np.bool_]) -> list[cv2.KeyPoint]:
    """So many, half of them where they are favoured; what one half lacks, the other has."""
    height, width = favoured.shape
    inside: list[cv2.KeyPoint] = []
    outside: list[cv2.KeyPoint] = []
    for one in found:
        x, y = min(max(round(one.pt[0]), 0), width - 1), min(max(round(one.pt[1]), 0), height - 1)
        (inside if favoured[y, x] else outside).append(one)
    taken = max(min(len(inside), count // 2), count - len(outside))
    return inside[:taken] + outside[: count - taken]
