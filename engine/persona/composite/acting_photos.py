"""The two photographs of a collection that a persona keeps: the one that acts, and the one that lends its teeth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.skin_colour import is_grey
from engine.perception.face.landmarks import FACE_OVAL
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.composite.portrait_selection import portrait_photo
from engine.persona.mouth.teeth_selection import teeth_photo
from engine.persona.persona import Persona

PORTRAIT_REACH = ((2.2, 1.8), (2.2, 2.6))
"""Faces' heights that are kept about the face's middle: to the left and above, to the right and below."""
TEETH_REACH = ((0.6, 0.6), (0.6, 0.7))


def with_acting_photos(
    persona: Persona,
    faces: Sequence[PhotoFace],
    photo: Callable[[int], NDArray[np.uint8]],
    wanted: int | None = None,
) -> Persona:
    """The persona with both, of its `faces`, each in what `photo` gives for its number. `wanted` : the face that is to act; by default
    the best one."""
    if wanted is None:
        portrait = portrait_photo(faces, persona.belief[:, persona.frame.face].mean(axis=1) / 255, photo)
    else:
        portrait = FacePhoto(photo(wanted), faces[wanted].mesh, wanted)
    teeth = teeth_photo(faces, photo, portrait is not None and is_grey(portrait.rgb, portrait.mesh))
    return replace(
        persona,
        portrait=None if portrait is None else around(portrait, PORTRAIT_REACH),
        teeth=None if teeth is None else around(teeth, TEETH_REACH),
    )


def around(photo: FacePhoto, reach: tuple[tuple[float, float], tuple[float, float]]) -> FacePhoto:
    """The part of a photograph that reaches so many of its face's heights to both sides of its middle, as `PORTRAIT_REACH` says it."""
    oval = photo.mesh[list(FACE_OVAL), :2]
    low, high = oval.min(axis=0), oval.max(axis=0)
    middle, height = (low + high) / 2, float(high[1] - low[1])
    start, end = middle - height * np.array(reach[0]), middle + height * np.array(reach[1])
    size = np.array(photo.rgb.shape[1::-1])
    return photo.cut(np.clip(np.floor(start), 0, size - 1).astype(int), np.clip(np.ceil(end), 1, size).astype(int))
