"""What a person wears on the face that is not fitted: glasses and beards, by many frames."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.avatar.landmarks.in_frames import FrameLandmarks
from engine.errors import Notice

MIN_FACE_FRAMES = 3
"""Frames that must tell of a face."""
MIN_BRIDGE_STRENGTH = 0.05
"""Of `engine.perception.face.face_wear.FaceWear.bridge`, in the median frame, from which glasses are worn."""
MIN_BEARD_LIP_DARKNESS = 1.1
"""Of `FaceWear.lip_darkness`, from which a beard is: a third of the cheek's light."""


def worn_on_face(seen: Sequence[FrameLandmarks]) -> tuple[Notice, ...]:
    """What the user should know of a face that frames have `seen`; nothing where fewer than three tell of it."""
    notices = []
    if _median([one.wear.bridge for one in seen]) > MIN_BRIDGE_STRENGTH:
        notices.append(
            Notice(
                "glasses_as_skin",
                "The person seems to wear glasses. They are not modelled: what frames show of them lies on the face as"
                " paint. Film the head without them.",
            )
        )
    if _median([one.wear.lip_darkness for one in seen]) > MIN_BEARD_LIP_DARKNESS:
        notices.append(
            Notice(
                "beard_as_skin",
                "The person seems to have a beard or a moustache. It is not modelled as hair: it is skin of its colour, which"
                " stands off as far as the head's clip shows.",
            )
        )
    return tuple(notices)


def _median(values: Sequence[float]) -> float:
    known = np.array(values)[np.isfinite(values)]
    return float(np.median(known)) if len(known) >= MIN_FACE_FRAMES else -np.inf
