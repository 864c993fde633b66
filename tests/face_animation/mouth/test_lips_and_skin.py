"""Lips press the skin beside them together, and do not go over it."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.lips_and_skin import (
    LOWER_LIP_COLUMNS,
    MIN_SKIN_SHARE,
    NARROW_LIP_SKIN_SHARE,
    SKIN_ABOVE_COLUMNS,
    SKIN_BELOW_COLUMNS,
    UPPER_LIP_COLUMNS,
    keep_lips_off_skin,
    philtrum_compression,
)

UNIT = 60.0
REST = placed(UNIT, (150, 120))
ANY = np.array([MIN_SKIN_SHARE])


def torn(face: NDArray[np.float32], by: float) -> NDArray[np.float32]:
    """The upper lip up and the lower lip down by so many eye distances, no skin with them; a face upright in the picture."""
    out = face.copy()
    for lips, skin, way in ((UPPER_LIP_COLUMNS, SKIN_ABOVE_COLUMNS, -1), (LOWER_LIP_COLUMNS, SKIN_BELOW_COLUMNS, 1)):
        moved = np.column_stack([np.array(skin)[:, 0], np.array(lips)])
        out[moved, 1] += way * by * UNIT
    return out


def steps(face: NDArray[np.floating]) -> list[NDArray[np.floating]]:
    """Pixels from each vertex to the next, from the lips' borders outwards, above and below."""
    return [
        way * np.diff(face[np.array(skin), 1], axis=1)
        for skin, way in ((SKIN_ABOVE_COLUMNS, -1), (SKIN_BELOW_COLUMNS, 1))
    ]


def led_back(
    face: NDArray[np.float32], room: float = MIN_SKIN_SHARE, rest: NDArray[np.float32] = REST
) -> NDArray[np.floating]:
    faces = face[None].astype(float)
    keep_lips_off_skin(faces, rest, np.array([room]))
    return np.asarray(faces[0])


def test_faces_whose_lips_are_where_they_belong_stay_as_they_are() -> None:
    """Also those that press no part of the skin to less than six tenths."""
    for face in (REST, opened(REST, 0.015)):
        np.testing.assert_array_equal(led_back(face), face.astype(float))


def test_lips_over_the_skin_press_it_together_and_no_further() -> None:
    acted = torn(REST, 0.5)
    assert min(s.min() for s in steps(acted)) < 0
    back = led_back(acted)
    for kept, usual in zip(steps(back), steps(REST), strict=True):
        assert (kept >= MIN_SKIN_SHARE * usual - 1e-3).all()
    ends = [column[-1] for column in (*SKIN_ABOVE_COLUMNS, *SKIN_BELOW_COLUMNS)]
    np.testing.assert_array_equal(back[ends], acted[ends].astype(float))
    assert np.abs(back[:, 0] - acted[:, 0]).max() < 1e-6
    others = np.setdiff1d(
        np.arange(478),
        np.concatenate(
            [np.ravel(c) for c in (UPPER_LIP_COLUMNS, SKIN_ABOVE_COLUMNS, LOWER_LIP_COLUMNS, SKIN_BELOW_COLUMNS)]
        ),
    )
    np.testing.assert_array_equal(back[others], acted[others].astype(float))


def test_where_the_skin_has_room_the_lips_go_on() -> None:
    """The chin is long enough for a lip that passes its first vertices: they make way for it, and it stays."""
    acted = torn(REST, 0.2)
    back = led_back(acted)
    lip, first, *_ = SKIN_BELOW_COLUMNS[4]
    assert steps(acted)[1][4, 0] < 0 < steps(back)[1][4, 0]
    assert back[lip, 1] == pytest.approx(float(acted[lip, 1])) and back[first, 1] > acted[first, 1] + 1


def test_skin_gives_way_evenly_before_any_of_it_is_pressed_to_a_line() -> None:
    """A lip that takes a quarter of the chin's room leaves every part half of its breadth, and is not held back."""
    acted = REST.copy()
    columns = [*np.array(SKIN_BELOW_COLUMNS)[:, 0], *np.ravel(LOWER_LIP_COLUMNS)]
    acted[columns, 1] += 0.25 * (REST[152, 1] - REST[17, 1])
    back = led_back(acted)
    middle = slice(2, 7)  # of the columns, whose skin is broadest
    assert (steps(acted)[1][middle, 0] < MIN_SKIN_SHARE * steps(REST)[1][middle, 0]).all()
    assert (steps(back)[1][middle] >= 0.45 * steps(REST)[1][middle]).all()
    lip = SKIN_BELOW_COLUMNS[4][0]
    assert back[lip, 1] == pytest.approx(float(acted[lip, 1]))


def test_a_lip_keeps_its_thickness() -> None:
    acted = torn(REST, 0.5)
    moved = (led_back(acted) - acted)[:, 1]
    for lips, skin in ((UPPER_LIP_COLUMNS, SKIN_ABOVE_COLUMNS), (LOWER_LIP_COLUMNS, SKIN_BELOW_COLUMNS)):
        columns = np.column_stack([np.array(skin)[:, 0], np.array(lips)])
        np.testing.assert_allclose(np.ptp(moved[columns], axis=1), 0, atol=1e-6)
    assert np.abs(moved[list(UPPER_LIP_COLUMNS[4])]).max() > 1


@pytest.mark.parametrize("roll", [-90, 35])
def test_a_head_that_is_inclined_is_led_back_along_itself(roll: float) -> None:
    c, s = np.cos(np.deg2rad(roll)), np.sin(np.deg2rad(roll))
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    acted = torn(REST, 0.5)
    inclined = led_back((acted @ turn).astype(np.float32), rest=(REST @ turn).astype(np.float32))
    np.testing.assert_allclose(inclined, led_back(acted) @ turn, atol=0.02)


def test_each_face_is_led_back_by_its_own_rest() -> None:
    """Faces that turn, as a picture shows them in each frame, are led back as each is alone."""
    torn_ones = np.stack([torn(REST, 0.5), torn(REST, 0.2)]).astype(float)
    rests, turns = np.stack([REST, REST]).astype(float), np.array([[[1, 0], [0, 1]], [[0, -1], [1, 0]]], float)
    for faces in (torn_ones, rests):
        faces[..., :2] = faces[..., :2] @ turns
    alone = torn_ones.copy()
    for k in range(2):
        keep_lips_off_skin(alone[k : k + 1], rests[k], np.array([MIN_SKIN_SHARE]))
    keep_lips_off_skin(torn_ones, rests, np.full(2, MIN_SKIN_SHARE))
    np.testing.assert_allclose(torn_ones, alone, atol=1e-9)


def test_the_driver_says_how_far_the_skin_under_the_nose_is_pressed() -> None:
    nose, lip = (float(REST[v, 1]) for v in (SKIN_ABOVE_COLUMNS[4][2], SKIN_ABOVE_COLUMNS[4][0]))
    usual = (lip - nose) / UNIT
    rooms = philtrum_compression(np.stack([REST, torn(REST, 0.75 * usual), torn(REST, 2.0)]), REST)
    np.testing.assert_allclose(rooms, [NARROW_LIP_SKIN_SHARE, 0.25, MIN_SKIN_SHARE], atol=1e-3)
    tight, wide = (led_back(torn(REST, 0.5), room) for room in (MIN_SKIN_SHARE, NARROW_LIP_SKIN_SHARE))
    for back, share in ((tight, MIN_SKIN_SHARE), (wide, NARROW_LIP_SKIN_SHARE)):
        assert back[SKIN_ABOVE_COLUMNS[4][0], 1] - back[SKIN_ABOVE_COLUMNS[4][2], 1] == pytest.approx(
            share * usual * UNIT, abs=0.01
        )
