"""Which faces are kept, and why others are not."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.persona.collection.person import Belonging
from engine.persona.collection.photo_face import PhotoFace

MAX_YAW_DEGREES, MAX_PITCH_DEGREES = 35.0, 30.0
"""Degrees: beyond, one side of the face, or its forehead or chin, is not seen."""
MIN_PHOTO_EYE_DISTANCE_PIXELS = 22.0
"""Pixels: in smaller faces lids and teeth are a pixel or two."""
MAX_FACE_BLUR = 0.62
"""Of `PhotoFace.blur`."""
DUPLICATE_CORRELATION, DUPLICATE_DISTANCE = 0.98, 0.25
"""Of chips and of descriptors, at once: the same picture, in another size or another file."""

Reason = Literal[
    "left_out",
    "somebody_else",
    "uncertain",
    "turned",
    "tiny",
    "blurred",
    "duplicate",
    "other_years",
    "other_look",
    "covered",
]
"""`covered` is told of a whole collection, once its photographs lie on one another (`engine.persona.learning`)."""


@dataclass(frozen=True)
class Choice:
    """What somebody has said of faces, by their numbers: to keep them whatever speaks against it, or to leave them out.
    Also the first and the last of the `years` that are meant, and which `look` is."""

    keep: Collection[int] = ()
    leave_out: Collection[int] = ()
    years: tuple[int, int] | None = None
    look: int | None = None


def reasons_against(faces: Sequence[PhotoFace], belonging: Belonging, choice: Choice) -> tuple[Reason | None, ...]:
    """For each of the faces why it is of no use, None where it is kept. Of duplicates the largest is kept."""
    reasons = [
        _reason(face, belongs, number, choice)
        for number, (face, belongs) in enumerate(zip(faces, belonging.belongs, strict=True))
    ]
    kept = [number for number, reason in enumerate(reasons) if reason is None]
    for number in _duplicates([faces[k] for k in kept]):
        if kept[number] not in choice.keep:
            reasons[kept[number]] = "duplicate"
    return tuple(reasons)


def _reason(face: PhotoFace, belongs: str, number: int, choice: Choice) -> Reason | None:
    if number in choice.leave_out:
        return "left_out"
    if number in choice.keep:
        return None
    if belongs != "person":
        return "somebody_else" if belongs == "other" else "uncertain"
    if choice.years is not None and not (face.year and choice.years[0] <= face.year <= choice.years[1]):
        return "other_years"
    if abs(face.yaw) > MAX_YAW_DEGREES or abs(face.pitch) > MAX_PITCH_DEGREES:
        return "turned"
    if face.eye_distance < MIN_PHOTO_EYE_DISTANCE_PIXELS:
        return "tiny"
    return "blurred" if face.blur > MAX_FACE_BLUR else None


def _duplicates(faces: Sequence[PhotoFace]) -> list[int]:
    """Which of the faces show what a larger one of them shows, too."""
    if len(faces) < 2:
        return []
    largest_first = sorted(range(len(faces)), key=lambda k: -faces[k].eye_distance)
    chips = np.array([faces[k].chip for k in largest_first], np.float32).reshape(len(faces), -1)
    chips -= chips.mean(1, keepdims=True)
    chips /= np.maximum(np.linalg.norm(chips, axis=1, keepdims=True), 1e-6)
    alike = _pairs_above(chips, DUPLICATE_CORRELATION)
    found: set[int] = set()
    for one, other in alike:
        apart = faces[largest_first[one]].descriptor - faces[largest_first[other]].descriptor
        if one not in found and float(np.linalg.norm(apart)) < DUPLICATE_DISTANCE:
            found.add(other)
    return [largest_first[k] for k in sorted(found)]


def _pairs_above(vectors: NDArray[np.float32], least: float) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, of unit vectors (N, D) whose product is above `least`, by their first."""
    first, second = np.nonzero(np.triu(vectors @ vectors.T > least, 1))
    return list(zip(first.tolist(), second.tolist(), strict=True))
