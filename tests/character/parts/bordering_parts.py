"""Drawn figures of which it is known whose each pixel is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS

TORSO, LEFT_ARM, LEFT_LEG, RIGHT_LEG = (
    BODY_PARTS.index(name) for name in ("torso", "left_arm", "left_leg", "right_leg")
)
BLUE, SKIN, WHITE, WALL = (40, 60, 140), (220, 170, 140), (245, 245, 245), (90, 140, 60)
Drawn = tuple[NDArray[np.uint8], NDArray[np.int8]]


def beside_an_arm(sleeve: tuple[int, int, int]) -> Drawn:
    """A blue trunk, columns 20 to 79, and an arm beside it, 80 to 105."""
    rgb, labels = np.full((120, 130, 3), WALL, np.uint8), np.full((120, 130), -1, np.int8)
    rgb[10:110, 20:80], labels[10:110, 20:80] = BLUE, TORSO
    rgb[10:110, 80:106], labels[10:110, 80:106] = sleeve, LEFT_ARM
    return rgb, labels
