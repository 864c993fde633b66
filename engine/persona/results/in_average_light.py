"""A photograph of the collection in the light that all have in the mean, as it is: its shape, its expression, its surroundings.

Section 5 warps all photographs to one of them, as the frame leads from each to it, and mixes them there: that is the skin. Eyes, the
mouth's inside, and what is beside the face are the photograph's own, lit as the face is now.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import soft_polygon
from engine.perception.face.landmarks import LEFT_EYE, LIPS_INNER, RIGHT_EYE, eye_distance
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.light.relighting import over_photo, regenerated, relit
from engine.persona.persona import Persona
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH_PIXELS

MIXTURE_RAMP_PIXELS = (2.0, 14.0)
"""Pixels of a frame 194 wide from the face's rim, between which the mixture begins and is whole."""
OPENING_OUTLINES = (RIGHT_EYE, LEFT_EYE, LIPS_INNER)
OPENING_BLUR_EYE_DISTANCES = 0.015
"""Eye distances over which openings for eyes and mouth pass into the skin."""


def in_average_light(persona: Persona, photo: FacePhoto) -> NDArray[np.uint8]:
    """(h, w, 3) `photo`, which is one of the persona's, in the collection's average light."""
    at = over_photo(persona, photo)
    if at is None:
        return photo.rgb
    mixed = regenerated(persona, photo.number).astype(np.float32)
    lit = relit(persona, photo, mixed)
    face = persona.frame.face.astype(np.uint8)
    inside = cv2.distanceTransform(face, cv2.DIST_L2, 3) * (REFERENCE_WIDTH_PIXELS / face.shape[1])
    share = np.clip((inside - MIXTURE_RAMP_PIXELS[0]) / (MIXTURE_RAMP_PIXELS[1] - MIXTURE_RAMP_PIXELS[0]), 0, 1).astype(
        np.float32
    )
    covered = cv2.remap(share, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    covered = np.asarray(covered, np.float32) * (1 - _openings(photo))
    there = cv2.remap(mixed, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    lit += covered[..., None] * (np.asarray(there, np.float32) - lit)
    return np.clip(np.rint(lit), 0, 255).astype(np.uint8)


def _openings(photo: FacePhoto) -> NDArray[np.float32]:
    """(h, w) where eyes and the mouth's inside are: these stay the photograph's, since a mixture has no gaze and no teeth."""
    face, shape = photo.mesh[:, :2].astype(np.float32), photo.rgb.shape[:2]
    mask = sum(
        (soft_polygon(face[list(contour)], (shape[0], shape[1])) for contour in OPENING_OUTLINES),
        np.zeros(shape, np.float32),
    )
    return np.asarray(
        cv2.GaussianBlur(mask, (0, 0), max(0.5, OPENING_BLUR_EYE_DISTANCES * float(eye_distance(face)))), np.float32
    )
