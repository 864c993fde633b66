"""The dark line of closed lips fades in the corners of a mouth that is rounded, and nothing else does."""

from __future__ import annotations

import cv2
import numpy as np
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.creases.corner_seams import CornerSeams
from engine.face_animation.creases.own_folds import OwnFolds
from engine.perception.face.landmarks import LIPS_OUTER, MOUTH_CORNER_VERTICES

SIZE = (500, 520)
FACE = placed(100.0, (250.0, 220.0))
SKIN, LIPS, SEAM = (205, 160, 140), (170, 90, 95), (40, 20, 20)
IDENTITY = (2 * (np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), axis=-1) + 0.5) - 0.5).astype(np.float32)


def picture() -> NDArray[np.uint8]:
    """Closed lips whose line goes on beyond both corners."""
    rgb = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    cv2.fillPoly(rgb, [FACE[list(LIPS_OUTER), :2].round().astype(np.int32)], LIPS)
    right, left = (FACE[corner, :2].round().astype(int) for corner in MOUTH_CORNER_VERTICES)
    cv2.line(rgb, (int(right[0]) - 5, int(right[1])), (int(left[0]) + 5, int(left[1])), SEAM, 3)
    return rgb


def rounded(narrower: float, gap: float) -> NDArray[np.float32]:
    """The face with a mouth narrower by a share, and open by a share of its width."""
    face = FACE.copy()
    corners = list(MOUTH_CORNER_VERTICES)
    middle = face[corners, 0].mean()
    face[corners, 0] = middle + (1 - narrower) * (face[corners, 0] - middle)
    face[14, 1] = face[13, 1] + gap * abs(face[corners[1], 0] - face[corners[0], 0])
    return face


def eased(face: NDArray[np.floating], with_folds: bool = False) -> NDArray[np.uint8]:
    rgb = picture()
    folds, frame = OwnFolds(rgb, FACE), rgb.copy()
    if with_folds:
        folds.ease(frame, IDENTITY, 2, face)
    CornerSeams(rgb, FACE, folds).ease(frame, IDENTITY, 2, face)
    return frame


def _at(frame: NDArray[np.uint8], aside: int = 0) -> list[int]:
    """The darkest light of each corner, or so many pixels further to the mouth's middle."""
    found = []
    for corner, way in zip(MOUTH_CORNER_VERTICES, (1, -1), strict=True):
        x, y = FACE[corner, :2].round().astype(int)
        found.append(int(frame[y - 2 : y + 3, x + way * aside].sum(axis=-1).min()))
    return found


def test_a_mouth_that_says_o_has_lips_in_its_corners() -> None:
    assert max(_at(picture())) < 110
    assert min(_at(eased(rounded(0.25, 0.6)))) > 220
    assert min(_at(eased(rounded(0.0, 0.9)))) > 220, "one that gapes, too"


def test_what_is_not_rounded_keeps_its_line() -> None:
    for face in (FACE, rounded(0.25, 0.0), rounded(0.0, 0.4)):
        np.testing.assert_array_equal(eased(face), picture())


def test_it_fades_in_the_corners_alone_and_nothing_becomes_darker() -> None:
    frame = eased(rounded(0.25, 0.6))
    assert (frame >= picture()).all()
    assert max(_at(frame, aside=25)) < 110, "the middle of the line is the mouth's"
    assert (
        frame[: int(FACE[MOUTH_CORNER_VERTICES[0], 1]) - 40] == picture()[: int(FACE[MOUTH_CORNER_VERTICES[0], 1]) - 40]
    ).all()


def test_with_the_folds_eased_too_no_corner_glares() -> None:
    frame = eased(rounded(0.25, 0.6), with_folds=True)
    assert frame.max(axis=(0, 1)).tolist() <= [one + 6 for one in SKIN]
