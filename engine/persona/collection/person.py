"""Whose photographs these are: the one person whom most faces show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from engine.errors import InputError
from engine.perception.identity.descriptor import IdentityDistances
from engine.persona.collection.photo_face import PhotoFace

CORE_SHARE = 5 / 6
"""Of the distance below which two faces are one person's: those that are nearer to a face are its neighbours."""
GROWING_ROUNDS = 3
"""Rounds in which faces join the person's, and leave them."""
SECOND_PERSON_SHARE = 0.6
"""Of as many faces as the person has, from which on another may be meant just as well."""
ALONE_SHARE = 0.5
"""Width of a photograph's second face, in widths of its largest, below which the largest is whom it was taken of."""

Belongs = Literal["person", "uncertain", "other"]


@dataclass(frozen=True)
class Belonging:
    """Of N faces.

    belongs : (N,) to whom.
    distance : (N,) float32 the median of those to the person's faces.
    shown : whom else the photographs may mean as well: for each of two people a face and how often they are shown;
        empty where one is clearly meant.
    """

    belongs: tuple[Belongs, ...]
    distance: NDArray[np.float32]
    shown: tuple[tuple[int, int], ...] = ()

    def require_one(self) -> None:
        """Raises `InputError` `several_people` where it is not clear who is meant."""
        if self.shown:
            (first, count), (second, others) = self.shown
            raise InputError(
                "several_people",
                f"The photos show two people about as often ({count} and {others} faces): choose whom you mean, by the option example:"
                f" face {first} of faces.json shows one, face {second} the other.",
                ("example",),
                {"examples": [first, second]},
            )


def belonging(faces: Sequence[PhotoFace], distances: IdentityDistances, example: int | None = None) -> Belonging:
    """Which of the faces are the person's: whom most faces show, or whom the face `example` shows.

    A photograph shows the person once at most. What is neither near nor far belongs where it is the face that its photograph was
    taken of; otherwise it is uncertain.

    Raises
    ------
    InputError : `no_common_person` (no two faces are of one person).
    """
    apart = _distances(faces) if faces else np.zeros((0, 0), np.float32)
    core = _cluster(apart, distances, np.arange(len(faces)) if example is None else np.array([example]))
    if len(core) < 2:
        raise InputError(
            "no_common_person", "No two faces of these photos are one person's: send photos of one person."
        )
    median = np.median(apart[:, core], axis=1)
    alone = _is_alone(faces)
    kinds: list[Belongs] = []
    for face, distance in enumerate(median):
        near = distance < distances.same or (distance < distances.other and alone[face])
        kinds.append("person" if near else "uncertain" if distance < distances.other else "other")
    for photo in {face.photo for face in faces}:
        same = [k for k, face in enumerate(faces) if face.photo == photo and kinds[k] == "person"]
        for second in sorted(same, key=lambda k: median[k])[1:]:
            kinds[second] = "other"
    shown = _shown(apart, median, core, distances) if example is None else ()
    return Belonging(tuple(kinds), np.asarray(median, np.float32), shown)


def _distances(faces: Sequence[PhotoFace]) -> NDArray[np.float32]:
    """(N, N) Euclidean distances of descriptors."""
    described = np.array([face.descriptor for face in faces], np.float32).reshape(len(faces), -1)
    squares = (described**2).sum(1)
    return np.sqrt(np.maximum(squares[:, None] + squares[None] - 2 * described @ described.T, 0))


def _cluster(apart: NDArray[np.float32], distances: IdentityDistances, among: NDArray[np.integer]) -> NDArray[np.intp]:
    """The faces of the person whom most of the faces in `among` show: from the one with most neighbours, grown by medians."""
    if not len(among):
        return np.zeros(0, np.intp)
    near = apart < CORE_SHARE * distances.same
    core = np.flatnonzero(near[among[near[among].sum(1).argmax()]])
    for _ in range(GROWING_ROUNDS):
        grown = np.flatnonzero(np.median(apart[:, core], axis=1) < distances.same)
        core = grown if len(grown) else core
    return core


def _shown(
    apart: NDArray[np.float32], median: NDArray[np.floating], core: NDArray[np.intp], distances: IdentityDistances
) -> tuple[tuple[int, int], ...]:
    """The person and another one, each with a face and how often they are shown, where the photographs may mean the other as well."""
    others = np.flatnonzero(median >= distances.other)
    if not len(others):
        return ()
    second = others[_cluster(apart[np.ix_(others, others)], distances, np.arange(len(others)))]
    if len(second) < SECOND_PERSON_SHARE * len(core):
        return ()
    return (int(core[median[core].argmin()]), len(core)), (int(second[0]), len(second))


def _is_alone(faces: Sequence[PhotoFace]) -> list[bool]:
    """Whether each face is its photograph's only or by far largest one."""
    seconds: dict[int, float] = {}
    for face in faces:
        if face.size_share < 1:
            seconds[face.photo] = max(seconds.get(face.photo, 0.0), face.size_share)
    return [face.size_share == 1 and seconds.get(face.photo, 0.0) < ALONE_SHARE for face in faces]
