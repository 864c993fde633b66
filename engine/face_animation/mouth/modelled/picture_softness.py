"""How soft a picture's own edges are at eyes and lips: no tooth that is modelled in it is sharper."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.imaging.edge_blur import edge_blur
from engine.perception.face.landmarks import LEFT_EYE, LIPS_OUTER, RIGHT_EYE, eye_distance

REACH_EYE_DISTANCES = 0.06
"""Eye distances around eyes and lips that are looked at."""
SOFTNESS_RANGE_PIXELS = (0.6, 3.0)
"""Pixels."""


def picture_softness(rgb: NDArray[np.uint8], mesh: NDArray[np.floating]) -> float:
    """The standard deviation of the blur, eye distances, that edges at the eyes and lips of a face at `mesh` (478, 2 or 3) of a picture
    (H, W, 3) have; the least that is believed where it shows none."""
    unit = float(eye_distance(mesh[:, :2]))
    mask = np.zeros(rgb.shape[:2], np.uint8)
    for contour in (LEFT_EYE, RIGHT_EYE, LIPS_OUTER):
        cv2.fillPoly(mask, [np.rint(mesh[list(contour), :2]).astype(np.int32)], 1)
    reach = 2 * max(round(REACH_EYE_DISTANCES * unit), 1) + 1
    mask = np.asarray(cv2.dilate(mask, np.ones((reach, reach), np.uint8)))
    blur = edge_blur(cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY), mask > 0)
    return float(np.clip(blur or 0.0, *SOFTNESS_RANGE_PIXELS)) / unit
