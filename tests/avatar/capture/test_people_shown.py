"""A clip of a whole person, one of their head, one of two people and one of nobody are told apart."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.capture.people_shown import PeopleShown, look_for_people, refuse_wrong_clips
from engine.character.sample import sample_picture
from engine.errors import InputError


def code(body: PeopleShown, head: PeopleShown | None = None) -> str:
    with pytest.raises(InputError) as refused:
        refuse_wrong_clips(body, head)
    return refused.value.code


@pytest.fixture(scope="module")
def whole() -> NDArray[np.uint8]:
    return sample_picture()


@pytest.fixture(scope="module")
def of_body(whole: NDArray[np.uint8]) -> PeopleShown:
    return look_for_people([whole, whole])


@pytest.fixture(scope="module")
def of_head(whole: NDArray[np.uint8], of_body: PeopleShown) -> PeopleShown:
    """The upper third of the person, larger."""
    scale = whole.shape[0] / of_body.size[0]
    points = of_body.people[0][0].points * scale
    left, top = points[:, 0].min(), points[:, 1].min()
    tall = np.ptp(points[:, 1])
    x = max(0, round(float(left - 0.1 * tall)))
    y = max(0, round(float(top - 0.15 * tall)))
    part = whole[y : round(float(top + 0.25 * tall)), x : round(float(points[:, 0].max() + 0.1 * tall))]
    return look_for_people([cv2.resize(part, None, fx=3, fy=3, interpolation=cv2.INTER_CUBIC)])


def test_clips_in_each_other_s_place_are_told(of_body: PeopleShown, of_head: PeopleShown) -> None:
    assert of_body.share_with_knees == 1 and of_head.share_with_knees == 0
    refuse_wrong_clips(of_body, of_head)
    assert code(of_head, of_body) == "clips_swapped"


def test_two_people_and_nobody_are_refused(whole: NDArray[np.uint8], of_body: PeopleShown) -> None:
    beside = look_for_people([np.concatenate([whole, whole[:, ::-1]], axis=1)])
    assert beside.share_with_company == 1 and of_body.share_with_company == 0
    assert code(beside) == "two_people"
    passing = PeopleShown({k: (beside if k == 3 else of_body).people[0] for k in range(8)}, of_body.size)
    refuse_wrong_clips(passing, None)
    empty = look_for_people([np.full((320, 180, 3), 127, np.uint8)])
    assert code(empty) == "no_person"
    assert of_body.bodies(2)[0] is of_body.people[0][0] and empty.bodies(2) == [None, None]
