"""Hair over a forehead is told from skin, and what it covers stays with the skull."""

from __future__ import annotations

import cv2
import numpy as np
from made_face import painted, placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_points import place_control_points
from engine.face_animation.motion_transfer.fringe import fringe_share
from engine.perception.face.landmarks import FACE_OVAL, LEFT_BROW, RIGHT_BROW

SIZE = (240, 280)
FACE = placed(60.0, (120.0, 130.0))
BARE = painted(FACE, SIZE)
EYES = int(FACE[[33, 263], 1].mean())


def haired(left: int, right: int) -> NDArray[np.uint8]:
    """The face with dark hair from above down to the brows, between two columns."""
    out = BARE.copy()
    cv2.rectangle(out, (left, 0), (right, EYES - 18), (40, 30, 28), -1)
    return out


def test_a_bare_forehead_is_not_covered() -> None:
    assert fringe_share(BARE, FACE).max() < 0.05


def test_a_fringe_covers_brows_and_forehead_and_nothing_else() -> None:
    share = fringe_share(haired(0, SIZE[0]), FACE)
    assert share[list(LEFT_BROW[:5] + RIGHT_BROW[:5])].min() > 0.5
    assert (share[FACE[:, 1] > EYES] == 0).all()


def test_hair_on_one_side_covers_one_brow() -> None:
    share = fringe_share(haired(0, 105), FACE)
    assert share[list(RIGHT_BROW[:3])].min() > 0.7 and share[list(LEFT_BROW)].max() < 0.05


def test_what_is_covered_does_not_move_by_itself() -> None:
    person = np.zeros(SIZE[::-1], np.float32)
    cv2.fillConvexPoly(person, FACE[list(FACE_OVAL), :2].round().astype(np.int32), 1.0)
    control = place_control_points(FACE, person, rgb=haired(0, SIZE[0]))
    np.testing.assert_allclose(control.bare, 1 - fringe_share(haired(0, SIZE[0]), FACE))
    assert (place_control_points(FACE, person).bare == 1).all()
