"""A photograph of the collection in the light that all have in the mean, as it is: its shape, its expression, its surroundings.

Section 5 warps all photographs to one of them, as the frame leads from each to it, and mixes them there: that is the skin. Eyes, the
mouth's inside, and what is beside the face are the photograph's own, lit as the face is now.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import box_around, soft_polygon
from engine.imaging.filling.nearest import nearest_values
from engine.imaging.warping.mesh_warp import inverse_map
from engine.perception.face_tessellation import face_triangles, opening_triangles
from engine.perception.landmarks import FACE_OVAL, LEFT_EYE, LIPS_INNER, MESH_SIZE, RIGHT_EYE, eye_distance
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.composite.low_frequencies import low_frequencies
from engine.persona.persona import Persona
from engine.persona.results.pictures import regenerated
from engine.persona.texture.appearance_subspace import REFERENCE_WIDTH
from engine.persona.texture.texture_frame import sampled

GAIN_RANGE = (0.4, 2.5)
"""By which light may change."""
DARK = 8.0
"""Grey levels that are added on both sides of a ratio, so that black is no division by nothing."""
RIM = (2.0, 14.0)
"""Pixels of a frame 194 wide from the face's rim, between which the mixture begins and is whole."""
OPENINGS = (RIGHT_EYE, LEFT_EYE, LIPS_INNER)
OPENING_SIGMA = 0.015
"""Eye distances over which they pass into the skin."""
SPREAD = 0.35
"""Eye distances over which what is beside the face takes the light of its rim."""


def in_average_light(persona: Persona, photo: FacePhoto) -> NDArray[np.uint8]:
    """(h, w, 3) `photo`, which is one of the persona's, in the collection's average light."""
    frame, height, width = persona.frame, *photo.rgb.shape[:2]
    face = photo.mesh[:MESH_SIZE, :2].astype(np.float32)
    box = box_around(face[list(FACE_OVAL)], (height, width))
    if box is None:
        return photo.rgb
    mixed = regenerated(persona, photo.number).astype(np.float32)
    own = sampled(photo.rgb, frame.lookup(photo.mesh))
    believed = frame.face * persona.belief[photo.number].astype(np.float32) / 255
    was, becomes = (low_frequencies(one, believed, frame.scale) for one in (own, mixed))
    gain = np.clip((becomes + DARK) / (was + DARK), *GAIN_RANGE)
    inside = cv2.distanceTransform(frame.face.astype(np.uint8), cv2.DIST_L2, 3) * (REFERENCE_WIDTH / frame.size[1])
    share = np.clip((inside - RIM[0]) / (RIM[1] - RIM[0]), 0, 1)
    x0, y0, x1, y1 = box
    source = frame.places[:MESH_SIZE, :2].astype(np.float32)
    triangles = np.concatenate([face_triangles(), opening_triangles()])
    at = inverse_map(face - np.array([x0, y0], np.float32), source, triangles, (y1 - y0, x1 - x0), photo.mesh[:, 2])
    known = np.zeros((height, width), np.bool_)
    known[y0:y1, x0:x1] = at[..., 0] >= 0
    gains = np.ones((height, width, 3), np.float32)
    gains[y0:y1, x0:x1] = _looked_up(gain, at, cv2.BORDER_REPLICATE)
    sigma = SPREAD * float(eye_distance(photo.mesh[:, :2]))
    lit = (photo.rgb + DARK) * cv2.GaussianBlur(nearest_values(gains, known), (0, 0), sigma) - DARK
    part = lit[y0:y1, x0:x1]
    covered = _looked_up(share, at, cv2.BORDER_CONSTANT) * (
        1 - _openings(face - np.array([x0, y0], np.float32), part.shape[:2])
    )
    part += covered[..., None] * (_looked_up(mixed, at, cv2.BORDER_REPLICATE) - part)
    return np.clip(np.rint(lit), 0, 255).astype(np.uint8)


def _openings(face: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(h, w) where eyes and the mouth's inside are of a `face` (478, 2): these stay the photograph's, since a mixture has no gaze and no teeth."""
    mask = sum((soft_polygon(face[list(contour)], shape) for contour in OPENINGS), np.zeros(shape, np.float32))
    return np.asarray(cv2.GaussianBlur(mask, (0, 0), max(0.5, OPENING_SIGMA * float(eye_distance(face)))), np.float32)


def _looked_up(layer: NDArray[np.floating], at: NDArray[np.float32], border: int) -> NDArray[np.float32]:
    found = cv2.remap(np.asarray(layer, np.float32), at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=border)
    return np.asarray(found, np.float32)
