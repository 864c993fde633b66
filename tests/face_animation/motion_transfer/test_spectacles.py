"""Spectacles are one solid with the skull; lids move behind them, and a face that wears none is free."""

from __future__ import annotations

import cv2
import numpy as np
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.control_points import place_control_points
from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS, LID_SKIN_VERTEX_PAIRS
from engine.face_animation.motion_transfer.spectacles import spectacles_share
from engine.perception.face.landmarks import LIPS_OUTER

SIZE = (420, 420)
FACE = placed(90.0, (210.0, 180.0))
UNDER_RIM = (117, 118, 119, 346, 347, 348)
"""Vertices of the cheeks where lenses end."""


def picture(worn: bool) -> NDArray[np.uint8]:
    """A plain face, with or without two dark frames and a bridge that shines."""
    rgb = np.full((SIZE[1], SIZE[0], 3), (205, 160, 140), np.uint8)
    if worn:
        for inner, outer in ((133, 33), (362, 263)):
            middle = FACE[[inner, outer], :2].mean(axis=0).round().astype(int).tolist()
            cv2.ellipse(rgb, tuple(middle), (42, 30), 0, 0, 360, (30, 25, 25), 5, cv2.LINE_AA)
        y = round(float(FACE[6, 1]))
        rgb[y - 4 : y, 150:270] = 30
        rgb[y : y + 3, 150:270] = 240
        rgb[y + 3 : y + 7, 150:270] = 30
    return rgb


def test_a_face_without_spectacles_is_free() -> None:
    np.testing.assert_array_equal(spectacles_share(picture(worn=False), FACE), 0)


def test_where_a_frame_lies_the_skull_alone_moves() -> None:
    share = spectacles_share(picture(worn=True), FACE)
    assert share[list(UNDER_RIM)].min() > 0.95
    assert not share[np.ravel(LID_EDGE_VERTEX_PAIRS)].any(), "lids shut behind it"
    assert share[np.array(LID_SKIN_VERTEX_PAIRS)[:, 0]].min() > 0.95, "the frame may lie there"
    assert not share[list(LIPS_OUTER)].any()


def test_the_target_s_points_know_it() -> None:
    person = np.ones(SIZE[::-1], np.float32)
    with_frame = place_control_points(FACE, person, rgb=picture(worn=True)).bare
    assert with_frame[list(UNDER_RIM)].max() < 0.05 and (with_frame[np.ravel(LID_EDGE_VERTEX_PAIRS)] == 1).all()
