"""The outline between the lips: round, through the lips' vertices, and a little into the lips of an open mouth."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.face_animation.mouth.lip_contours import (
    LOWER_INNER_LIP,
    MAX_SEAM_EYE_DISTANCES,
    SAMPLES_PER_EDGE,
    SEAM_SHARE,
    UPPER_INNER_LIP,
    inner_lip_outline,
)
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE, eye_distance

EDGES = len(UPPER_INNER_LIP) - 1


def gaping(across: float, down: float) -> np.ndarray:
    """A face (478, 2) with eyes 100 pixels apart whose inner lips are an ellipse of these half axes."""
    face = np.zeros((478, 2), np.float32)
    face[list(RIGHT_EYE)], face[list(LEFT_EYE)] = (-50, -80), (50, -80)
    angle = np.linspace(np.pi, 0, EDGES + 1)
    for lip, sign in ((UPPER_INNER_LIP, -1), (LOWER_INNER_LIP, 1)):
        face[list(lip)] = np.column_stack([across * np.cos(angle), sign * down * np.sin(angle)])
    return face


def test_an_ellipse_stays_one_where_a_polygon_has_corners() -> None:
    face = gaping(30, 0.5)  # hardly open: the lips are not gone into
    outline = inner_lip_outline(face)
    assert len(outline) == 2 * SAMPLES_PER_EDGE * EDGES
    wide = gaping(30, 20)
    unit = float(eye_distance(wide))
    into = min(SEAM_SHARE * 40, MAX_SEAM_EYE_DISTANCES * unit)
    round_ = inner_lip_outline(wide)
    off = np.hypot(round_[:, 0] / 30, round_[:, 1] / (20 + into)) - 1
    polygon = wide[[*UPPER_INNER_LIP, *LOWER_INNER_LIP[-2:0:-1]]].astype(np.float32)
    assert cv2.contourArea(round_) > 1.02 * cv2.contourArea(polygon)
    assert np.abs(off[[k for k in range(len(off)) if abs(round_[k, 0]) < 25]]).max() < 0.03


def test_it_goes_through_the_vertices_of_lips_that_meet_and_round_their_corners() -> None:
    face = gaping(30, 0)
    outline = inner_lip_outline(face)
    np.testing.assert_allclose(outline[::SAMPLES_PER_EDGE][: EDGES + 1], face[list(UPPER_INNER_LIP)], atol=1e-4)
    assert cv2.contourArea(outline) == pytest.approx(0, abs=1e-3)
    ends = outline[[0, SAMPLES_PER_EDGE * EDGES]]
    np.testing.assert_allclose(ends, [[-30, 0], [30, 0]], atol=1e-4)
