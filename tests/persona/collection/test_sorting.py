"""Whose photographs these are, and which of them are of use."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.errors import InputError
from engine.perception.identity.descriptor import IdentityDistances
from engine.persona.collection.person import belonging
from engine.persona.collection.photo_face import PhotoFace
from engine.persona.collection.sorting import Choice, reasons_against

DISTANCES = IdentityDistances(same=0.6, other=0.7)


def face(photo: int, descriptor: np.ndarray, **more: float) -> PhotoFace:
    """Somebody's face, large, sharp and from the front; its chip is its own."""
    chip = np.random.default_rng(photo).integers(0, 255, (112, 112)).astype(np.uint8)
    usual = {"eye_distance": 60.0, "yaw": 0.0, "pitch": 0.0, "blur": 0.4, "size_share": 1.0}
    return PhotoFace(photo, np.zeros((478, 3), np.float32), **(usual | more), descriptor=descriptor, chip=chip)  # type: ignore[arg-type]


def person(seed: int, count: int, spread: float = 0.28) -> list[np.ndarray]:
    """Descriptors of one person: about 0.4 from each other, and about 0.9 from another's."""
    random = np.random.default_rng(seed)
    middle = random.normal(size=128)
    middle *= 0.6 / np.linalg.norm(middle)
    off = random.normal(size=(count, 128))
    return list((middle + spread * off / np.linalg.norm(off, axis=1, keepdims=True)).astype(np.float32))


def test_the_person_is_whom_most_faces_show() -> None:
    faces = [face(k, d) for k, d in enumerate([*person(1, 6), *person(2, 20), *person(3, 5)])]
    found = belonging(faces, DISTANCES)
    assert [b == "person" for b in found.belongs] == [6 <= k < 26 for k in range(31)]
    assert found.distance[6:26].max() < 0.6 < 0.7 < np.delete(found.distance, np.s_[6:26]).min()


def test_two_people_half_and_half_are_asked_about_and_an_example_answers() -> None:
    faces = [face(k, d) for k, d in enumerate([*person(1, 14), *person(2, 12)])]
    with pytest.raises(InputError) as error:
        belonging(faces, DISTANCES).require_one()
    assert error.value.code == "several_people" and error.value.correctable == ("example",)
    one, other = error.value.found["examples"]
    assert one < 14 <= other
    for example in (one, other):
        found = belonging(faces, DISTANCES, example)
        assert {k for k, b in enumerate(found.belongs) if b == "person"} == set(
            range(14) if example < 14 else range(14, 26)
        )


def test_nobody_twice_is_nobody() -> None:
    with pytest.raises(InputError) as error:
        belonging([face(k, person(k, 1)[0]) for k in range(5)], DISTANCES)
    assert error.value.code == "no_common_person"
    with pytest.raises(InputError):
        belonging([], DISTANCES)


def test_what_is_neither_near_nor_far_belongs_where_its_photo_was_taken_of_it() -> None:
    known = person(2, 20)
    middle = np.mean(known, axis=0)
    away = np.zeros(128, np.float32)
    away[np.abs(middle).argmin()] = 0.59  # 0.65 from the others: 0.59 across, 0.28 along
    doubtful = (middle + away).astype(np.float32)
    faces = [face(k, d) for k, d in enumerate(known)]
    alone = face(20, doubtful)
    large = [face(21, doubtful), face(21, person(5, 1)[0], size_share=0.4)]
    group = [face(22, person(6, 1)[0]), face(22, doubtful, size_share=0.9)]
    found = belonging([*faces, alone, *large, *group], DISTANCES)
    assert 0.6 < found.distance[20] < 0.7
    assert found.belongs[20:] == ("person", "person", "other", "other", "uncertain")


def test_a_photograph_shows_a_person_once() -> None:
    known = person(2, 20)
    twice = replace(face(20, known[3]), photo=4)
    found = belonging([*(face(k, d) for k, d in enumerate(known)), twice], DISTANCES)
    assert (found.belongs[4], found.belongs[20]).count("other") == 1


def test_each_reason_is_told() -> None:
    known = person(2, 20)
    usual = [face(k, d) for k, d in enumerate(known[:14])]
    odd = [
        face(14, known[14], yaw=-36),
        face(15, known[15], pitch=31),
        face(16, known[16], eye_distance=21),
        face(17, known[17], blur=0.8),
        face(18, person(7, 1)[0]),
        face(19, known[18]),
    ]
    faces = [*usual, *odd]
    found = belonging(faces, DISTANCES)
    reasons = reasons_against(faces, found, Choice(leave_out={19}))
    assert reasons == (None,) * 14 + ("turned", "turned", "tiny", "blurred", "somebody_else", "left_out")
    kept = reasons_against(faces, found, Choice(keep={14, 17}))
    assert kept[14] is None and kept[17] is None and kept[15] == "turned"


def test_of_the_same_picture_the_largest_is_kept() -> None:
    known = person(2, 16)
    faces = [face(k, d) for k, d in enumerate(known)]
    brighter = np.clip(faces[2].chip * 0.8 + 20, 0, 255).astype(np.uint8)
    faces.append(replace(faces[2], photo=16, eye_distance=80.0, chip=brighter, descriptor=known[2] + np.float32(0.005)))
    faces.append(replace(faces[2], photo=17, eye_distance=30.0))
    faces.append(replace(faces[5], photo=18, descriptor=known[6]))  # the chip alone is the same
    reasons = reasons_against(faces, belonging(faces, DISTANCES), Choice())
    assert [k for k, reason in enumerate(reasons) if reason == "duplicate"] == [2, 17]


def test_what_is_only_like_a_duplicate_stays() -> None:
    """The second is as the first, and the third as the second; the first and the third are two pictures."""
    known = person(2, 16)
    faces = [face(k, d) for k, d in enumerate(known)]
    one, other = np.random.default_rng(9).normal(size=(2, 112, 112))
    for place, degrees in enumerate((0, 8, 16)):
        turned = np.cos(np.radians(degrees)) * one + np.sin(np.radians(degrees)) * other
        chip = np.clip(128 + 25 * turned, 0, 255).astype(np.uint8)
        faces.append(replace(faces[2], photo=16 + place, eye_distance=90.0 - place, chip=chip))
    reasons = reasons_against(faces, belonging(faces, DISTANCES), Choice())
    assert [reason == "duplicate" for reason in reasons[16:]] == [False, True, False]
    chosen = reasons_against(faces, belonging(faces, DISTANCES), Choice(keep={17}))
    assert "duplicate" not in chosen, "somebody wants both"


def test_of_other_years_is_what_does_not_say_that_it_is_not() -> None:
    taken = (1984, 1990, 1991, None)
    faces = [replace(face(k, d), year=year) for (k, d), year in zip(enumerate(person(1, 4)), taken, strict=True)]
    found = reasons_against(faces, belonging(faces, DISTANCES), Choice(years=(1980, 1990)))
    assert found == (None, None, "other_years", "other_years")
    kept = reasons_against(faces, belonging(faces, DISTANCES), Choice(years=(1980, 1990), keep={3}))
    assert kept[3] is None
