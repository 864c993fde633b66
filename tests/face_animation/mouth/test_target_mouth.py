"""The one inside of a target's mouth: whose teeth, in which colours, and where."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, opened, painted, placed
from numpy.typing import NDArray

from engine.face_animation.mouth.lip_seam import LipSeam
from engine.face_animation.mouth.modelled.modelled_mouth import ModelledMouth
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth
from engine.face_animation.mouth.target_mouth import target_mouth
from engine.face_animation.target_face import TargetFace
from engine.perception.face.landmarks import LIPS_INNER

SIZE = (320, 340)
SMILE = 0.14


def target(mesh: NDArray[np.float32], rgb: NDArray[np.uint8]) -> TargetFace:
    return TargetFace(rgb, None, mesh, np.zeros((1, 4), np.float32), SIZE, np.eye(3)[:2])


def inside(mesh: NDArray[np.float32]) -> NDArray[np.bool_]:
    mask = np.zeros(SIZE[::-1], np.uint8)
    cv2.fillPoly(mask, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    return mask > 0


def with_teeth(mesh: NDArray[np.float32], crowns: bool) -> NDArray[np.uint8]:
    """A smile of white teeth, and between them lines, if crowns are seen."""
    rgb = painted(mesh, SIZE)
    rows, columns = np.nonzero(inside(mesh))
    rgb[rows, columns] = (225, 215, 200)
    lines = columns % 8 < 2
    if crowns:
        rgb[rows[lines], columns[lines]] = (140, 125, 110)
    return rgb


def test_a_picture_s_own_teeth_are_kept_where_crowns_are_seen() -> None:
    smiling = opened(placed(90, (160, 120)), SMILE)
    own, band = (target_mouth(target(smiling, with_teeth(smiling, crowns))) for crowns in (True, False))
    assert isinstance(own, LipSeam) and isinstance(band, LipSeam)
    assert isinstance(own.inside, PhotoTeeth)
    assert isinstance(band.inside, ModelledMouth)


def test_at_rest_a_closed_mouth_stays_as_it_is_and_what_opens_is_drawn_within_the_lips() -> None:
    closed = placed(90, (160, 120))
    mouth = target_mouth(target(closed, painted(closed, SIZE)))
    for face, drawn in ((closed, False), (opened(closed, 0.4), True)):
        frame = np.full((*SIZE[::-1], 3), 128, np.uint8)
        mouth.draw(frame, face[:, :2], 0)
        changed = (frame != 128).any(axis=-1)
        assert changed.any() == drawn
        assert not changed[cv2.dilate(inside(face).astype(np.uint8), np.ones((13, 13), np.uint8)) == 0].any()


def test_what_parted_lips_show_but_for_crowns_is_never_seen() -> None:
    """A grey tongue in the picture's mouth: as it closes and opens, the same light teeth are there."""
    parted = opened(placed(90, (160, 120)), SMILE)
    rgb = painted(parted, SIZE)
    rgb[inside(parted)] = (95, 85, 85)
    mouth = target_mouth(target(parted, rgb))
    light = []
    for opening in (0.09, SMILE, 0.2):
        face = opened(placed(90, (160, 120)), opening)
        frame = painted(face, SIZE)
        frame[inside(face)] = (95, 85, 85)
        mouth.draw(frame, face[:, :2], 0)
        light.append(np.percentile(frame[inside(face)].mean(axis=1), 97))
    assert min(light) > 0.8 * np.mean(SKIN)
    assert max(light) < 1.15 * min(light), "in a slit they are as light"


def test_it_is_the_same_whatever_the_driver_shows() -> None:
    closed = placed(90, (160, 120))
    mouth = target_mouth(target(closed, painted(closed, SIZE)))
    one, other = (np.zeros((*SIZE[::-1], 3), np.uint8) for _ in range(2))
    for frame, number in ((one, 0), (other, 77)):
        mouth.draw(frame, opened(closed, 0.4)[:, :2], number)
    np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("cast", [(1.0, 1.0, 1.0), (1.0, 0.8, 0.6), (0.8, 0.8, 1.1), (0.4, 0.35, 0.3)])
def test_no_inside_is_bluer_or_greener_than_the_skin_or_a_grey(cast: tuple[float, float, float]) -> None:
    closed = placed(90, (160, 120))
    rgb = np.clip(painted(closed, SIZE) * np.array(cast), 0, 255).astype(np.uint8)
    frame = rgb.copy()
    wide = opened(closed, 0.4)
    target_mouth(target(closed, rgb)).draw(frame, wide[:, :2], 0)
    seen = frame[cv2.erode(inside(wide).astype(np.uint8), np.ones((9, 9))) > 0].astype(float)
    skin = np.array(SKIN) * cast
    bluest = max(1.0, skin[2] / skin[0])
    assert (seen[:, 2] <= bluest * seen[:, 0] + 4).all(), "no violet, no blue"
    assert (seen[:, 1] <= max(1.0, skin[1] / skin[0]) * seen[:, 0] + 4).all(), "no green"
