"""Hair over a forehead: it hangs from the skull and lies before the brows, which move beneath it.

Where a picture shows hair within the mesh of a face, what brows do would drag it along, in waves. There the skull alone
carries the picture.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.even_brows import brow_share
from engine.face_animation.skin_colour import chroma
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import MESH_SIZE, eye_distance

SKIN_VERTICES = (8, 168, 6, 50, 280, 117, 346, 205, 425)
"""Between the brows, on the nose's bridge and on the cheeks, which hair seldom covers."""
FRINGE_LIGHT_RATIOS = (0.38, 0.52)
"""Of the skin's light: what has less is hair, and what has more is skin."""
FRINGE_CHROMA_DIFFERENCES = (0.1, 0.16)
"""By how much a pixel's shares of red and blue differ from the skin's, up to which it is skin, and from which on it is hair."""
FOREHEAD_BAND_EYE_DISTANCES = (-0.32, -0.7)
"""Eye distances above the eyes between which the forehead above the brows is looked at (`canonical_face`)."""
FRINGE_BLUR_EYE_DISTANCES = 0.14
"""Over which what is hair and what is skin is averaged."""
COVERED_SHARES = (0.5, 0.8)
"""Of the pixels around a place, that are hair where it begins to be covered, and is."""


def fringe_share(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> NDArray[np.float64]:
    """(478,) how far the brows and the forehead of a face at `mesh` (478, 2 or 3), pixels of a picture (H, W, 3), are covered by hair; 0 below."""
    unit = float(eye_distance(mesh[:, :2]))
    left, top = np.maximum(np.floor(mesh[:, :2].min(axis=0)).astype(int), 0)
    right, bottom = np.ceil(mesh[:, :2].max(axis=0)).astype(int) + 1
    patch = rgb[top:bottom, left:right]
    if min(patch.shape[:2]) < 2:
        return np.zeros(MESH_SIZE)
    places = np.clip(np.rint(mesh[:, :2] - (left, top)).astype(int), 0, np.array(patch.shape[1::-1]) - 1)
    smooth = cv2.GaussianBlur(patch, (0, 0), max(0.03 * unit, 0.5)).astype(np.float32)
    skin = np.median(smooth[places[list(SKIN_VERTICES), 1], places[list(SKIN_VERTICES), 0]], axis=0)
    light = smooth.sum(axis=2) / max(float(skin.sum()), 1.0)
    hair = 1 - _ramp(light, *FRINGE_LIGHT_RATIOS)
    hair = np.maximum(hair, _ramp(np.abs(chroma(smooth) - chroma(skin)).max(axis=2), *FRINGE_CHROMA_DIFFERENCES))
    around = cv2.GaussianBlur(hair.astype(np.float32), (0, 0), FRINGE_BLUR_EYE_DISTANCES * unit)
    upright = canonical_face()[:, 1]
    above = (upright < FOREHEAD_BAND_EYE_DISTANCES[0]) & (upright > FOREHEAD_BAND_EYE_DISTANCES[1])
    column = np.abs(mesh[:, None, 0] - mesh[None, above, 0]) / unit
    weight = np.exp(-0.5 * (column / FRINGE_BLUR_EYE_DISTANCES) ** 2)
    covered = (weight * around[places[above, 1], places[above, 0]]).sum(axis=1) / weight.sum(axis=1)
    return np.asarray(brow_share() * _ramp(covered, *COVERED_SHARES), float)


def _ramp(value: NDArray[np.floating], low: float, high: float) -> NDArray[np.floating]:
    return np.clip((value - low) / (high - low), 0, 1)
