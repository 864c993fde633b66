"""Lips press the skin beside them together, and do not go over it."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.portrait.lips_and_skin import LEAST, LOWER, MOST, UPPER, breadths, clear_of_skin, pressed

UNIT = 60.0
REST = placed(UNIT, (150, 120))
LIPS = sorted({v for column in (*UPPER, *LOWER) for v in column[1:]})
BESIDE = [column[0] for column in (*UPPER, *LOWER)]


def torn(face: NDArray[np.float32], by: float) -> NDArray[np.float32]:
    """The upper lip up and the lower lip down by so many eye distances, no skin with them; a face upright in the picture."""
    out = face.copy()
    for columns, way in ((UPPER, -1), (LOWER, 1)):
        out[np.array(columns)[:, 1:], 1] += way * by * UNIT
    return out


def test_a_face_at_rest_has_its_lips_beside_the_skin() -> None:
    assert breadths(REST[None]).min() > 0
    np.testing.assert_allclose(breadths(torn(REST, 0.05)[None]), breadths(REST[None]) - 0.05 * UNIT, atol=1e-3)


@pytest.mark.parametrize("roll", [0, 35, -90])
@pytest.mark.parametrize("yields", [0.0, 0.5, 1.0])
def test_lips_that_lie_over_the_skin_are_led_back_to_its_edge(roll: float, yields: float) -> None:
    faces = np.stack([REST, torn(REST, 0.4)])
    turned = faces.copy()
    c, s = np.cos(np.deg2rad(roll)), np.sin(np.deg2rad(roll))
    turned[..., :2] = faces[..., :2] @ np.array([[c, s], [-s, c]], np.float32)
    before = turned.copy()
    assert (breadths(turned)[1] < 0).any()
    clear_of_skin(turned, np.zeros((1, 18)), yields)
    assert breadths(turned).min() > -1e-3
    np.testing.assert_array_equal(turned[0], before[0])
    moved = np.linalg.norm(turned[1] - before[1], axis=1)
    assert (moved[LIPS].max() > 0) == (yields < 1) and (moved[BESIDE].max() > 0) == (yields > 0)
    others = [v for v in range(478) if v not in LIPS and v not in BESIDE]
    assert moved[others].max() == 0
    np.testing.assert_allclose(
        np.diff(moved[np.array(UPPER)[:, 1:]], axis=1), 0, atol=1e-4
    )  # a lip keeps its thickness


def test_skin_keeps_the_breadth_it_is_given() -> None:
    faces = torn(REST, 0.4)[None]
    least = 0.3 * breadths(REST[None])
    clear_of_skin(faces, least)
    np.testing.assert_allclose(np.maximum(breadths(faces), least), breadths(faces), atol=1e-3)


def test_how_far_the_skin_is_pressed_is_said_as_a_share() -> None:
    faces = np.stack([REST, torn(REST, 0.07), torn(REST, 0.6), opened(REST, 0.3)])
    share = pressed(faces, REST, UNIT)
    usual = breadths(REST[None])[0]
    wide = usual > 0.1 * UNIT
    assert wide.any()
    assert (share[0, wide] == MOST).all()
    np.testing.assert_allclose(share[1, wide], np.clip(1 - 0.07 * UNIT / usual[wide], LEAST, MOST), atol=1e-4)
    assert (share[2] == LEAST).all()


def test_a_short_lip_under_a_long_one_s_motion_stays_below_the_nose() -> None:
    """What presses two thirds of a long upper lip together, presses a short one to a third, not beyond its skin."""
    short = REST.copy()
    lips = np.array(UPPER)[:, 1:]
    short[lips, 1] -= 0.6 * breadths(REST[None])[0, :9, None]
    acted = torn(REST, 0.1)
    share = pressed(acted[None], REST, UNIT)
    carried = (short + acted - REST)[None].astype(float)
    assert breadths(carried)[0, :9].min() < 0
    clear_of_skin(carried, share * breadths(short[None]))
    assert (breadths(carried)[0, :9] >= LEAST * breadths(short[None])[0, :9] - 1e-6).all()
