"""Lips that the picture shows parted meet in a dark line, and nothing of it is seen while they are apart."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import opened, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_seam import MEETING_OPENINGS, SEAM_LIGHT_SHARE, LipSeam, met_share

LIPS = np.array([180.0, 100, 100])


class White:
    """An inside that is white all over the frame."""

    def draw(self, frame: NDArray[np.uint8], face: NDArray[np.float32], driver_frame: int) -> None:
        frame[:] = 255


def drawn(opening: float) -> tuple[NDArray[np.uint8], NDArray]:
    face = opened(placed(90, (150, 150)), opening)[:, :2].astype(np.float32)
    frame = np.full((300, 300, 3), 120, np.uint8)
    LipSeam(White(), LIPS).draw(frame, face, 0)
    return frame, face


def test_closed_lips_have_a_line_and_no_inside() -> None:
    frame, face = drawn(0.0)
    x, y = face[[13, 14]].mean(axis=0).round().astype(int)
    np.testing.assert_allclose(frame[y, x], SEAM_LIGHT_SHARE * LIPS, atol=12)
    assert (frame < 121).all()
    np.testing.assert_array_equal(frame[y + 12, x], 120)


def test_parted_lips_show_the_inside_alone() -> None:
    frame, _ = drawn(0.2)
    assert (frame == 255).all()


def test_the_line_comes_with_the_closing() -> None:
    shares = [met_share(opening) for opening in np.linspace(0, 0.1, 21)]
    assert shares[0] == 1 and shares[-1] == 0
    assert (np.diff(shares) <= 0).all()
    assert met_share(sum(MEETING_OPENINGS) / 2) == pytest.approx(0.5)


def test_no_edge_of_the_picture_s_teeth_is_left_beside_the_line() -> None:
    """Neither above nor below it, where landmarks are wrong."""
    face = opened(placed(90, (150, 150)), 0.0)[:, :2].astype(np.float32)
    x, y = face[[13, 14]].mean(axis=0).round().astype(int)
    frame = np.full((300, 300, 3), 120, np.uint8)
    frame[y - 3 : y + 4, x - 10 : x + 11] = 255
    LipSeam(White(), LIPS).draw(frame, face, 0)
    assert frame[y - 3 : y + 4, x - 10 : x + 11].max() < 225
    assert (frame[y + 14, x] == 120).all()
