"""Which photograph of the person acts: from before, large, sharp, bare, with a calm face, the whole head, and nobody beside."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from engine.face_animation.skin_colour import is_grey
from engine.perception.face.landmarks import eye_opening, mouth_opening
from engine.persona.collection.face_photo import FacePhoto
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.composite.framing import head_box

LARGE_FACE_EYE_DISTANCE_PIXELS = 140.0
"""Pixels from which on a face is as large as any picture asks for."""
HALF_SIZE_TURN_DEGREES = 8.0
"""By which a face is turned, that counts as much as if it were half as large; the same is true of the following."""
MAX_CLOSED_MOUTH_OPENING = 0.06
"""Of the mouth: what is behind closed lips can be drawn, and open ones have a shape of their own."""
MAX_HIDDEN_HEAD_SHARE = 0.05
"""Of the head, that the photograph does not show."""
HIDDEN_FACE_SCALE = 0.08
"""Of the face, that is behind hair, spectacles, hands, or in a hard shadow."""
BLUR_SCALE = 0.15
MIN_EYE_OPENING = 0.2
"""Of the eyes; shut ones stay shut."""
SHUT_PENALTY, GREY_PENALTY, BESIDE_PENALTY = 3.0, 3.0, 2.0
"""Of shut eyes, of black and white among photographs in colour, and of each face beside: whose pixels are whose is not always seen."""
MAX_PORTRAIT_CANDIDATES = 32
"""Photographs that are looked at, of those whose faces are best."""
MIN_SHOWN_HEAD_SHARE = 0.5
"""Of the head that the photograph has to show."""
WHOLE_HEAD_SHARE = 0.85


def portrait_photo(
    faces: Sequence[PhotoFace], belief: NDArray[np.floating], photo: Callable[[int], NDArray[np.uint8]]
) -> FacePhoto | None:
    """The photograph, of `faces` each in what `photo` gives for its number, that is best; None where all of them cut the head.

    `belief` (N,) is the mean of the faces' pixels'.
    """
    hidden = np.maximum(float(np.quantile(belief, 0.9)) - belief, 0)
    scores = np.array([_face_score(face) for face in faces]) - hidden / HIDDEN_FACE_SCALE
    some = np.argsort(-scores, kind="stable")[:MAX_PORTRAIT_CANDIDATES]
    found = [FacePhoto(photo(int(number)), faces[number].mesh, int(number)) for number in some]
    shares = [head_share(one) for one in found]
    grey = np.array([is_grey(one.rgb, one.mesh) for one in found])
    whole = scores[some] - (1 - np.array(shares)) / MAX_HIDDEN_HEAD_SHARE - GREY_PENALTY * (grey & (grey.mean() < 0.5))
    whole[np.array(shares) < MIN_SHOWN_HEAD_SHARE] = -np.inf
    return found[int(np.argmax(whole))] if np.isfinite(whole).any() else None


def head_share(photo: FacePhoto) -> float:
    """How much of the head lies in the photograph: a share of its area."""
    low, high = head_box(photo.mesh)
    inside = np.clip(high, 0, photo.rgb.shape[1::-1]) - np.clip(low, 0, photo.rgb.shape[1::-1])
    return float(np.prod(inside) / np.prod(high - low))


def _face_score(face: PhotoFace) -> float:
    """In halvings of its size; zero is best."""
    score = min(float(np.log2(face.eye_distance / LARGE_FACE_EYE_DISTANCE_PIXELS)), 0.0)
    score -= float(np.hypot(face.yaw, face.pitch)) / HALF_SIZE_TURN_DEGREES
    score -= float(mouth_opening(face.mesh)) / MAX_CLOSED_MOUTH_OPENING + face.blur / BLUR_SCALE
    score -= BESIDE_PENALTY * face.beside
    return score - SHUT_PENALTY * (float(eye_opening(face.mesh).min()) < MIN_EYE_OPENING)
