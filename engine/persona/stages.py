"""The stages of a persona: what is stored of each, and what it is made of."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.media.limits import Limits
from engine.perception.expression.features import frontalise
from engine.perception.identity.backend import descriptor_distances, descriptor_name, face_descriptor
from engine.perception.identity.descriptor import IdentityDistances
from engine.perception.solutions import kept_networks
from engine.persona.collection.appearance_clusters import appearance_clusters
from engine.persona.collection.coverage import rare, shown_expressions, shown_sides
from engine.persona.collection.person import Belonging, belonging
from engine.persona.collection.photo_face import PhotoFace, faces_of
from engine.persona.collection.photos import Photos, read_photos
from engine.persona.collection.rest import at_rest
from engine.persona.collection.sorting import Choice, Reason, reasons_against
from engine.persona.learning import LearntPersona, learn_persona

MIN_PERSONA_PHOTOS = 15
"""That can be used, for a persona."""
MIN_DRIVER_PHOTOS = 8
"""That can be used, for what a driver's face is like at rest: the quarter that shows least is of two then."""
EYE_SHARE = 67 / 194
"""Of a texture's width, between the eyes."""
MAX_ENLARGEMENT_RATIO = 1.6
"""Of the median photograph's face, by which textures may be larger: many photographs together are finer than one."""
MIN_FACE_TEXTURE_WIDTH_PIXELS, MAX_FACE_TEXTURE_WIDTH_PIXELS = 194, 400
"""Pixels of a texture: the paper's, and one that a portrait of 800 pixels has use for."""
FRAME_ASPECT_RATIO = 244 / 194

REFUSAL_PHRASES: dict[Reason, str] = {
    "somebody_else": "show somebody else",
    "uncertain": "may show somebody else",
    "turned": "are turned too far aside, up or down",
    "tiny": "are too small",
    "blurred": "are blurred",
    "duplicate": "are there twice",
    "other_years": "are of other years, or do not say of which",
    "other_look": "show another look",
    "covered": "are covered, in a light of their own, or painted",
    "left_out": "were left out",
}


@dataclass(frozen=True)
class PhotoFaces:
    """The faces of all photographs."""

    faces: tuple[PhotoFace, ...]


@dataclass(frozen=True)
class SortedFaces:
    """The faces of a collection, why each is of no use (`Reason`, None where it is kept), and whose they are. Also of
    which of the person's looks each is that is of use, or would be were it of the look that is meant."""

    faces: tuple[PhotoFace, ...]
    reasons: tuple[Reason | None, ...]
    whose: Belonging
    looks: tuple[int | None, ...]

    @property
    def kept(self) -> list[PhotoFace]:
        """Those that are of use."""
        return [face for face, reason in zip(self.faces, self.reasons, strict=True) if reason is None]

    @property
    def left_out(self) -> dict[Reason, int]:
        """How many faces are of no use for each reason, the most frequent first."""
        return dict(Counter(reason for reason in self.reasons if reason is not None).most_common())

    def require_enough(self) -> None:
        """Raises `InputError`: `several_people`, `too_few_photos`."""
        self.whose.require_one()
        kept = self.reasons.count(None)
        if kept < MIN_PERSONA_PHOTOS:
            raise InputError(
                "too_few_photos",
                f"{MIN_PERSONA_PHOTOS} photos of the person are needed, and {kept} can be used: {MIN_PERSONA_PHOTOS - kept} more, from before."
                f"{_lacking(self.kept)}{_spoken(self.left_out)}",
                ("photos",),
            )

    def place(self, number: int, option: str = "photo") -> int:
        """Which of `kept` a face is, by its number among all, which `option` names. Raises `InputError` `photo_not_used`."""
        if number >= len(self.reasons) or self.reasons[number] is not None:
            raise InputError(
                "photo_not_used",
                f"Face {number} is not among those that are used: choose one that `faces.json` says is kept, or name it in `keep`, too.",
                (option, "keep"),
            )
        return self.reasons[:number].count(None)

    def without_covered(self, used: NDArray[np.bool_]) -> SortedFaces:
        """With those of `kept` that were not `used` left out as covered."""
        kept = [number for number, reason in enumerate(self.reasons) if reason is None]
        covered = {number for number, one in zip(kept, used, strict=True) if not one}
        reasons = ("covered" if number in covered else reason for number, reason in enumerate(self.reasons))
        return replace(self, reasons=tuple(reasons))


@kept_networks()
def find_faces_of_photos(
    photos: Photos,
    described_by: str,
    tick: Callable[[float], None],
    on_photo: Callable[[NDArray[np.uint8], Sequence[PhotoFace]], None] = lambda rgb, faces: None,
) -> PhotoFaces:
    """All faces, each with what decides whether it is of use. `described_by` names the model that tells people apart; `on_photo` is
    called with each photograph (H, W, 3) and its faces."""
    describe = face_descriptor(os.environ)
    found: list[PhotoFace] = []
    for number in range(len(photos)):
        rgb = photos.picture(number)
        faces = [replace(face, year=photos.years[number]) for face in faces_of(rgb, number, describe)]
        found += faces
        on_photo(rgb, faces)
        tick((number + 1) / len(photos))
    return PhotoFaces(tuple(found))


def sort_faces(found: PhotoFaces, distances: IdentityDistances, choice: Choice, example: int | None) -> SortedFaces:
    """Whose faces they are, and which are of use. Raises `InputError`: `no_common_person`, `look_unknown`."""
    whose = belonging(found.faces, distances, example)
    reasons = list(reasons_against(found.faces, whose, choice))
    kept = [number for number, reason in enumerate(reasons) if reason is None]
    told = dict(
        zip(kept, appearance_clusters([found.faces[number].descriptor for number in kept], distances.same), strict=True)
    )
    if choice.look is not None:
        if choice.look not in told.values():
            shown = len(set(told.values()))
            raise InputError(
                "look_unknown", f"The photos show {shown} look(s) of the person, counted from 0.", ("look",)
            )
        for number in kept:
            if told[number] != choice.look and number not in choice.keep:
                reasons[number] = "other_look"
    return SortedFaces(found.faces, tuple(reasons), whose, tuple(told.get(k) for k in range(len(found.faces))))


def learn(
    photos: Photos, chosen: SortedFaces, insisted: Collection[int], width: int, tick: Callable[[float], None]
) -> LearntPersona:
    """The persona of the faces that are of use, those among them that are `insisted` on, by their numbers among all, whatever covers
    them; textures `width` pixels wide."""
    kept = [(number, face) for number, face in enumerate(chosen.faces) if chosen.reasons[number] is None]
    meshes = np.array([face.mesh for _, face in kept])
    size = round(width * FRAME_ASPECT_RATIO), width
    sure = [place for place, (number, _) in enumerate(kept) if number in insisted]
    return learn_persona(meshes, lambda place: photos.picture(kept[place][1].photo), size, tick, sure)


@dataclass(frozen=True)
class DriverAtRest:
    """A driver's average face, (478, 3) float64 from the front, in eye distances."""

    face: NDArray[np.float64]


def rest_of_photos(paths: Sequence[Path], limits: Limits, tick: Callable[[float], None]) -> DriverAtRest:
    """The average face of whom most of the driver's photographs show, as the persona's own is found.

    Raises
    ------
    InputError : `no_common_person`, `too_few_driver_photos`, and what `read_photos` raises.
    """
    photos = read_photos(paths, limits)
    found = find_faces_of_photos(photos, descriptor_name(os.environ), tick)
    chosen = sort_faces(found, descriptor_distances(os.environ), Choice(), None)
    if len(chosen.kept) < MIN_DRIVER_PHOTOS:
        raise InputError(
            "too_few_driver_photos",
            f"{MIN_DRIVER_PHOTOS} photos of the driver are needed, and {len(chosen.kept)} can be used: send more, or none; then the"
            f" video alone tells what the face is like at rest.{_spoken(chosen.left_out)}",
            ("driver_photos",),
        )
    return DriverAtRest(at_rest(frontalise(np.array([face.mesh for face in chosen.kept]))))


def texture_width(kept: Sequence[PhotoFace]) -> int:
    """Pixels, as the photographs have them."""
    usual = float(np.median([face.eye_distance for face in kept])) / EYE_SHARE
    return int(
        np.clip(round(usual * MAX_ENLARGEMENT_RATIO), MIN_FACE_TEXTURE_WIDTH_PIXELS, MAX_FACE_TEXTURE_WIDTH_PIXELS)
    )


def _spoken(left_out: Mapping[Reason, int]) -> str:
    told = ", ".join(f"{count} {REFUSAL_PHRASES[reason]}" for reason, count in left_out.items())
    return f" Of the others {told}." if told else ""


def _lacking(kept: Sequence[PhotoFace]) -> str:
    few = rare(shown_expressions(kept) | shown_sides(kept))
    return f" Those that can be used show little of: {few}." if kept and few else ""
