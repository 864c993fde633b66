"""The colour of skin around a mouth, by which photographs are brought into one another's light."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.luminance import LUMINANCE_WEIGHTS
from engine.perception.face.landmarks import FACE_OVAL, eye_distance

MOUTH_SKIN_VERTICES = (164, 167, 393, 18, 200, 92, 322, 186, 410)
"""Vertices on the skin around the mouth."""
SKIN_SAMPLE_EYE_DISTANCES = 0.06
"""Eye distances about each of `MOUTH_SKIN_VERTICES` within which skin is sampled."""
CHROMA_FLOOR = 48.0
"""Added to the sum of a colour's channels, so that the dark has no colour."""
MAX_GREY_SATURATION = 0.06
"""Of skin, below which a picture is black and white."""


def skin_colour(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(3,) the mean sRGB of the skin around the mouth of a face at `mesh` (478, 2 or 3) of a picture."""
    reach = max(round(SKIN_SAMPLE_EYE_DISTANCES * float(eye_distance(mesh[:, :2]))), 1)
    patches = []
    for x, y in np.rint(mesh[list(MOUTH_SKIN_VERTICES), :2]).astype(int):
        patch = rgb[max(y - reach, 0) : max(y + reach + 1, 0), max(x - reach, 0) : max(x + reach + 1, 0)]
        if patch.size:
            patches.append(patch.reshape(-1, 3).mean(axis=0))
    return np.mean(patches, axis=0) if patches else np.full(3, 128.0)


def face_luminance(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float32]:
    """(N,) of the pixels of a picture (H, W, 3) within the oval of a face at `mesh` (478, 2 or 3); none where it lies beside the picture."""
    mask = np.zeros(rgb.shape[:2], np.uint8)
    cv2.fillPoly(mask, [mesh[list(FACE_OVAL), :2].round().astype(np.int32)], 1)
    return np.asarray(rgb[mask > 0].astype(np.float32) @ LUMINANCE_WEIGHTS, np.float32)


def is_grey(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> bool:
    """Whether a picture of a face at `mesh` (478, 2 or 3) is black and white."""
    skin = skin_colour(rgb, mesh)
    return float((skin.max() - skin.min()) / max(float(skin.max()), 1.0)) < MAX_GREY_SATURATION


def chroma(colours: NDArray[np.number]) -> NDArray[np.float32]:
    """(..., 2) the shares of red and blue of colours (..., 3), levels."""
    levels = colours.astype(np.float32)
    return np.asarray(
        (levels[..., ::2] + CHROMA_FLOOR / 3) / (levels.sum(axis=-1, keepdims=True) + CHROMA_FLOOR), np.float32
    )
