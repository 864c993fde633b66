"""What is measured of a face in every frame: known lengths come back, the head's turn apart from the face's own doing."""

from __future__ import annotations

import numpy as np
import pytest

from engine.perception.expression.measures import (
    FACE_MEASURES,
    LID_MEASURES,
    LID_VARIATION,
    MEASURES,
    general_rest,
    lid_lowering,
    measure,
)
from engine.perception.face.head_pose import canonical_face


def turn(yaw: float, pitch: float) -> np.ndarray:
    """(3, 3) by radians, for x right, y down, z away from the viewer."""
    c, s, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    about_y = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
    about_x = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    return about_y @ about_x


def smiling() -> np.ndarray:
    """(478, 3) the canonical face, eye distance 1, the corners of its mouth 0.14 higher and 0.08 further apart each."""
    face = canonical_face().astype(float)
    face[[61, 291], 1] -= 0.14
    face[61, 0] -= 0.08
    face[291, 0] += 0.08
    return face


def test_corners_moved_by_known_lengths_are_measured_by_them() -> None:
    moved = dict(zip(MEASURES, measure(smiling()[None] * 80 + (200, 220, 0))[0] - general_rest(), strict=True))
    assert (moved["right_corner_up"], moved["left_corner_up"]) == pytest.approx((0.14, 0.14), abs=1e-4)
    assert moved["mouth_wide"] == pytest.approx(0.16, abs=1e-3)
    assert (moved["inner_brows_up"], moved["yaw"], moved["pitch"]) == pytest.approx((0, 0, 0), abs=1e-4)


def test_measures_do_not_depend_on_where_the_head_is_and_how_it_is_turned() -> None:
    plain = measure(smiling()[None] * 80)[0]
    elsewhere = measure((smiling() @ turn(0.2, -0.15).T)[None] * 130 + (300, 40, 9))[0]
    face = slice(FACE_MEASURES.start, LID_MEASURES.start)
    assert elsewhere[face] == pytest.approx(plain[face], abs=1e-4)
    assert elsewhere[MEASURES.index("yaw")] == pytest.approx(0.2, abs=0.02)
    assert elsewhere[MEASURES.index("pitch")] == pytest.approx(-0.15, abs=0.02)


def test_lids_are_lowered_by_what_is_beyond_their_usual_variation() -> None:
    usual = np.array([0.3, 0.3])
    values = np.zeros((4, len(MEASURES)))
    values[:, LID_MEASURES] = [[0.3, 0.3], [0.25, 0.3], [0.15, 0.3], [0.0, 0.0]]
    assert lid_lowering(values, usual) == pytest.approx([0, 0, 0.5 - LID_VARIATION, 1 - LID_VARIATION])
