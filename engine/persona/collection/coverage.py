"""What a collection shows of its person: how many photographs there are of each expression and from each side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from engine.perception.expression.measures import FACE_MEASURES, MEASURES, REST_SPREAD, measure
from engine.persona.collection.photo_face import PhotoFace

MIN_EXPRESSION_SPREADS = 1.0
"""`REST_SPREAD` of a measure, from the person's own median, from which on a photograph shows what the measure tells."""
MIN_PHOTOS_OF_EXPRESSION = 8
"""Photographs that are mixed in a texture, at least: of fewer, other expressions show through."""
MIN_ANGLE_DEGREES = 12.0
"""Degrees aside, up or down from which on a photograph is not one from before."""

COVERED_EXPRESSIONS: Mapping[str, tuple[tuple[str, ...], int]] = {
    "an open mouth": (("mouth_open",), 1),
    "a smile": (("right_corner_up", "left_corner_up"), 1),
    "mouth corners drawn down": (("right_corner_up", "left_corner_up"), -1),
    "pursed lips": (("mouth_wide",), -1),
    "raised brows": (("inner_brows_up", "outer_brows_up"), 1),
    "lowered brows": (("inner_brows_up",), -1),
    "shut eyes": (("right_eye_open", "left_eye_open"), -1),
}
"""For each the measures that tell it, in the mean, and whether more or less than usual of them."""


def shown_expressions(faces: Sequence[PhotoFace]) -> dict[str, int]:
    """How many of the faces, whose median is taken to be the person's usual face, show each of `COVERED_EXPRESSIONS`."""
    if not faces:
        return dict.fromkeys(COVERED_EXPRESSIONS, 0)
    beyond = _beyond_usual(np.array([face.mesh for face in faces]))
    counts = {}
    for name, (measures, sign) in COVERED_EXPRESSIONS.items():
        told = sign * beyond[:, [MEASURES.index(one) for one in measures]].mean(axis=1)
        counts[name] = int((told > MIN_EXPRESSION_SPREADS).sum())
    return counts


def shown_sides(faces: Sequence[PhotoFace]) -> dict[str, int]:
    """How many of the faces are seen from before, turned to either side, up and down."""
    yaw, pitch = (np.array([getattr(face, name) for face in faces], float) for name in ("yaw", "pitch"))
    return {
        "from before": int(((np.abs(yaw) <= MIN_ANGLE_DEGREES) & (np.abs(pitch) <= MIN_ANGLE_DEGREES)).sum()),
        "turned to the picture's left": int((yaw < -MIN_ANGLE_DEGREES).sum()),
        "turned to the picture's right": int((yaw > MIN_ANGLE_DEGREES).sum()),
        "raised": int((pitch < -MIN_ANGLE_DEGREES).sum()),
        "lowered": int((pitch > MIN_ANGLE_DEGREES).sum()),
    }


def rare(counts: Mapping[str, int]) -> str:
    """In words, those of which there are few: `raised brows (3), shut eyes (none)`; empty where there are none."""
    few = {name: count for name, count in counts.items() if count < MIN_PHOTOS_OF_EXPRESSION}
    return ", ".join(f"{name} ({count or 'none'})" for name, count in few.items())


def _beyond_usual(meshes: NDArray[np.floating]) -> NDArray[np.float64]:
    values = measure(meshes)[:, FACE_MEASURES]
    return np.asarray((values - np.median(values, axis=0)) / REST_SPREAD[FACE_MEASURES], np.float64)
