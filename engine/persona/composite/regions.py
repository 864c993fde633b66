"""Where a face is retouched: in the persona's frame, so that the mask moves as the face does."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.perception.face.landmarks import LEFT_BROW, LEFT_EYE, LIPS_OUTER, RIGHT_BROW, RIGHT_EYE
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS
from engine.persona.texture.texture_frame import TextureFrame

WHOLE_NOSE_VERTICES = (168, 193, 417, 122, 351, 98, 327, 2, 1, 4, 19, 94, 97, 326, 129, 358, 48, 278)
"""The nose, from between the eyes to its wings: it has hardly a crease, nostrils that are a pixel off would be doubled, and the light and the shade on
both sides of its bridge, which stand there as the mean of photographs has them, would lie beside the photograph's."""
SKIN_RAMP_PIXELS = (4.0, 16.0)
"""Pixels of a frame 194 wide from the face's rim, between which the skin begins and is whole."""
EYE_ENLARGEMENT_AND_RAMP_PIXELS, NOSE_ENLARGEMENT_AND_RAMP_PIXELS, LIP_ENLARGEMENT_AND_RAMP_PIXELS = (
    (3.0, 2.0),
    (1.0, 1.5),
    (1.0, 1.5),
)
BROW_ENLARGEMENT_AND_RAMP_PIXELS = (1.0, 1.5)
"""Pixels of a frame 194 wide by which eyes, nose, lips and brows are drawn larger, and over which they pass into the skin."""


def retouched_skin(frame: TextureFrame) -> NDArray[np.float32]:
    """(H, W) in [0, 1] the skin of a persona's frame: the face without brows, eyes, nose and lips, and nothing at
    its rim."""
    inside = cv2.distanceTransform(frame.face.astype(np.uint8), cv2.DIST_L2, 3) * (
        REFERENCE_WIDTH_PIXELS / frame.size[1]
    )
    skin = np.clip((inside - SKIN_RAMP_PIXELS[0]) / (SKIN_RAMP_PIXELS[1] - SKIN_RAMP_PIXELS[0]), 0, 1)
    for contour, reach in (
        (RIGHT_EYE, EYE_ENLARGEMENT_AND_RAMP_PIXELS),
        (LEFT_EYE, EYE_ENLARGEMENT_AND_RAMP_PIXELS),
        (RIGHT_BROW, BROW_ENLARGEMENT_AND_RAMP_PIXELS),
        (LEFT_BROW, BROW_ENLARGEMENT_AND_RAMP_PIXELS),
        (WHOLE_NOSE_VERTICES, NOSE_ENLARGEMENT_AND_RAMP_PIXELS),
        (LIPS_OUTER, LIP_ENLARGEMENT_AND_RAMP_PIXELS),
    ):
        skin = skin * (1 - _grown(frame, contour, reach))
    return np.asarray(skin, np.float32)


def _grown(frame: TextureFrame, contour: tuple[int, ...], reach: tuple[float, float]) -> NDArray[np.float32]:
    """(H, W) the hull of a contour's vertices, drawn larger and softened."""
    unit = frame.size[1] / REFERENCE_WIDTH_PIXELS
    mask = np.zeros(frame.size, np.uint8)
    hull = cv2.convexHull(np.rint(frame.places[list(contour), :2]).astype(np.int32))
    cv2.fillConvexPoly(mask, hull, 1)
    side = 2 * round((reach[0] + 2 * reach[1]) * unit) + 1  # the softened edge lies inside
    larger = cv2.dilate(mask, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))).astype(np.float32)
    return np.asarray(cv2.GaussianBlur(larger, (0, 0), reach[1] * unit), np.float32)
