"""Which photograph lends its teeth."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_contours import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.skin_colour import is_grey
from engine.perception.face.landmarks import eye_distance, mouth_opening
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.collection.photo_face import PhotoFace

MAX_TEETH_YAW_DEGREES = 15.0
"""Degrees up to which a face shows both halves of its teeth."""
OPENING_RANGE = (0.10, 0.40)
"""Of the mouth: of less nothing is seen of teeth, and of more too much beside them."""
MIN_TEETH_EYE_DISTANCE_PIXELS = 48.0
"""Pixels: a tooth is an eighth as wide, and of fewer than six pixels enlarged becomes part of a white band."""
MAX_TEETH_CANDIDATES = 24
"""Photographs that are looked at, the largest of those that can be meant."""
BRIGHT_SHARES = (0.5, 1.0)
"""Of the skin's grey, between which a pixel becomes one of a tooth's."""
LARGE_TEETH_EYE_DISTANCE_PIXELS = 120.0
YAW_DEGREES, PITCH_DEGREES = 40.0, 40.0
"""By which a face is turned, that counts as much as teeth that are not seen at all; size and colour as follows."""
SIZE_SHARE, GREY_SHARE = 0.5, 1.0
SHARP_BLUR, BLUR_LIMITS = 0.4, 0.2
"""Of faces (`PhotoFace.blur`), from which on teeth are smeared, and by how much more they are worth nothing."""
OPENING_ROWS = 10
"""From lip to lip at which an opening is looked at."""
BURNT_GREY_LEVEL = 250.0
TEETH_HEIGHT_EYE_DISTANCES = 0.13
"""Eye distances of upper teeth that are seen wholly."""
WELL_LIT = 160.0
"""Of skin."""
TEETH_EDGE_SHARE = 0.5
"""Of teeth seen, that the dark below them counts: without it where they end is the lower lip's line, which is no tooth's."""


def teeth_photo(
    faces: Sequence[PhotoFace], photo: Callable[[int], NDArray[np.uint8]], grey: bool = False
) -> FacePhoto | None:
    """The photograph whose upper teeth are seen best, of `faces`, each in what `photo` gives for its number; None where none shows
    any. `grey` : the person is known in black and white alone."""
    able = [
        number
        for number, face in enumerate(faces)
        if abs(face.yaw) < MAX_TEETH_YAW_DEGREES
        and face.eye_distance >= MIN_TEETH_EYE_DISTANCE_PIXELS
        and OPENING_RANGE[0] <= float(mouth_opening(face.mesh)) <= OPENING_RANGE[1]
    ]
    able.sort(key=lambda number: -faces[number].eye_distance)
    best: tuple[float, FacePhoto] | None = None
    for number in able[:MAX_TEETH_CANDIDATES]:
        one = FacePhoto(photo(number), faces[number].mesh, number)
        score = _seen(one) + SIZE_SHARE * np.log(min(faces[number].eye_distance, LARGE_TEETH_EYE_DISTANCE_PIXELS) / 30)
        score -= abs(faces[number].yaw) / YAW_DEGREES + abs(faces[number].pitch) / PITCH_DEGREES
        score -= max(faces[number].blur - SHARP_BLUR, 0) / BLUR_LIMITS
        score -= GREY_SHARE * (is_grey(one.rgb, one.mesh) and not grey)
        if best is None or score > best[0]:
            best = float(score), one
    return best[1] if best else None


def _seen(photo: FacePhoto) -> float:
    """How well upper teeth are seen: how much of their height, not burnt white, in good light, and whether the dark below them shows
    where they end."""
    upper, lower = (photo.mesh[list(lip), :2] for lip in (UPPER_INNER_LIP, LOWER_INNER_LIP))
    down = (np.arange(OPENING_ROWS) + 0.5)[:, None, None] / OPENING_ROWS
    at = np.asarray(upper + down * (lower - upper), np.float32)
    pixels = np.asarray(cv2.remap(photo.rgb, at[..., 0], at[..., 1], cv2.INTER_LINEAR)).max(axis=-1).astype(np.float32)
    whole = photo.mesh[:, :2]
    a, b = np.floor(whole.min(axis=0)).astype(int).clip(0), np.ceil(whole.max(axis=0)).astype(int) + 1
    skin = max(float(np.percentile(photo.rgb[a[1] : b[1], a[0] : b[0]].max(axis=-1), 60)), 1.0)
    bright = np.clip((pixels / skin - BRIGHT_SHARES[0]) / (BRIGHT_SHARES[1] - BRIGHT_SHARES[0]), 0, 1)[:, 2:-2]
    burnt = (pixels[:, 2:-2] > BURNT_GREY_LEVEL).mean()
    gap = np.linalg.norm(lower - upper, axis=1)[2:-2] / float(eye_distance(photo.mesh[:, :2]))
    height = float((bright.mean(axis=0) * gap).mean()) / TEETH_HEIGHT_EYE_DISTANCES
    ends = float(np.clip(bright[: OPENING_ROWS // 2].mean() - bright[-2:].mean(), 0, 1))
    dark = 1 - min(skin / WELL_LIT, 1.0)
    return min(height, 1.0) - float(burnt) + TEETH_EDGE_SHARE * ends - 2 * dark
