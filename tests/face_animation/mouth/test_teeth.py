"""Teeth keep their shape between lips that move, in faces that the test moves itself."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.hidden_regions import LOWER_INNER_LIP, UPPER_INNER_LIP
from engine.face_animation.mouth.teeth import draw_teeth, find_teeth, teeth_positions
from engine.perception.landmarks import LIPS_INNER, LIPS_OUTER

REST = opened(placed(80, (200, 160)), 0.3)
LIPS = [*LIPS_OUTER, *LIPS_INNER]
SIZE = (400, 400)


def picture() -> NDArray[np.uint8]:
    """Smooth noise."""
    rng = np.random.default_rng(0)
    noise = cv2.GaussianBlur(rng.normal(0, 1, (*SIZE, 3)), (0, 0), 3)
    return np.clip(128 + 300 * noise, 0, 255).astype(np.uint8)


def with_lips(across: float, down: float) -> NDArray[np.float32]:
    """The face at rest with its lips scaled around their middle."""
    face = REST.copy()
    middle = face[LIPS, :2].mean(axis=0)
    face[LIPS, :2] = middle + (face[LIPS, :2] - middle) * (across, down)
    return face


def spots(face: NDArray) -> NDArray[np.float32]:
    """(478, 2) what lies behind the lips, where they have it."""
    behind = np.full((478, 2), np.nan, np.float32)
    behind[LIPS] = teeth_positions(REST[:, :2], face[:, :2])
    return behind


def test_at_rest_nothing_changes() -> None:
    np.testing.assert_allclose(spots(REST)[LIPS], REST[LIPS, :2], atol=1e-3)
    frame, teeth = picture(), find_teeth(picture(), REST)
    assert teeth is not None
    draw_teeth(frame, teeth, REST[:, :2])
    assert np.abs(frame.astype(int) - picture()).max() <= 1


@pytest.mark.parametrize(("scale", "roll"), [(1.2, 0.0), (0.8, 20.0)])
def test_a_head_that_moves_takes_them_along(scale: float, roll: float) -> None:
    turn = cv2.getRotationMatrix2D((150.0, 90.0), roll, scale)
    moved = REST[:, :2] @ turn[:, :2].T + turn[:, 2]
    np.testing.assert_allclose(spots(moved)[LIPS], REST[LIPS, :2], atol=1e-2)


def test_a_mouth_that_gets_smaller_covers_them() -> None:
    """What is seen is as large as the opening: nothing is pressed together."""
    pursed = with_lips(0.6, 0.7)
    seen = spots(pursed)
    upper, lower = list(UPPER_INNER_LIP[3:8]), list(LOWER_INNER_LIP[3:8])
    np.testing.assert_allclose(np.diff(seen[upper, 0]), np.diff(pursed[upper, 0]), atol=1e-2)
    np.testing.assert_allclose(seen[lower, 1] - seen[upper, 1], pursed[lower, 1] - pursed[upper, 1], atol=1e-2)


def test_a_mouth_that_gets_larger_shows_no_lip_in_their_place() -> None:
    seen = spots(with_lips(1.3, 1.4))
    outline = REST[list(LIPS_INNER), :2].astype(np.float32)
    inside = [cv2.pointPolygonTest(outline, (float(x), float(y)), True) for x, y in seen[list(LIPS_INNER)]]
    assert min(inside) > -1.5


def test_lips_that_close_press_the_mouth_s_inside_together() -> None:
    frame, teeth = picture(), find_teeth(picture(), REST)
    assert teeth is not None
    draw_teeth(frame, teeth, with_lips(1.0, 0.1)[:, :2])
    np.testing.assert_array_equal(frame, picture())


def test_closed_lips_show_none() -> None:
    assert find_teeth(picture(), placed(80, (200, 160))) is None
