"""The folds of a smile fade where the mouth is narrower than in its picture, and nothing else does."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed
from numpy.typing import NDArray

from engine.face_animation.creases.own_folds import OwnFolds, mouth_width
from engine.perception.face.landmarks import FACE_OVAL, LIPS_OUTER

SIZE = (300, 320)
FACE = placed(60.0, (150.0, 130.0))
SKIN, LIPS, FOLD = (205, 160, 140), (170, 90, 95), (140, 95, 80)
IDENTITY = 2 * (np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), axis=-1) + 0.5) - 0.5


def fold(side: int) -> NDArray[np.int32]:
    """From beside the nose past a corner of the mouth, on the right or the left."""
    corner, wing = (FACE[291, :2], FACE[358, :2]) if side > 0 else (FACE[61, :2], FACE[129, :2])
    outside = corner + np.array([side * 14, 6])
    return (
        np.array([wing + np.array([side * 8, 6]), (wing + outside) / 2 + np.array([side * 6, 0]), outside])
        .round()
        .astype(np.int32)
    )


def picture(moustache: bool = False) -> NDArray[np.uint8]:
    rgb = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    for side in (-1, 1):
        cv2.polylines(rgb, [fold(side)], False, FOLD, 4, cv2.LINE_AA)
    if moustache:
        cv2.fillPoly(rgb, [FACE[[98, 327, 291, 269, 0, 39, 61], :2].round().astype(np.int32)], (50, 40, 35))
    cv2.fillPoly(rgb, [FACE[list(LIPS_OUTER), :2].round().astype(np.int32)], LIPS)
    return rgb


def narrowed(share: float) -> NDArray[np.float32]:
    """The face with a mouth narrower by a share."""
    face = FACE.copy()
    middle = face[[61, 291], 0].mean()
    face[[61, 291], 0] = middle + (1 - share) * (face[[61, 291], 0] - middle)
    return face


def eased(rgb: NDArray[np.uint8], share: float) -> NDArray[np.uint8]:
    frame = rgb.copy()
    OwnFolds(rgb, FACE).ease(frame, IDENTITY.astype(np.float32), 2, narrowed(share))
    return frame


def on_folds(rgb: NDArray[np.uint8]) -> float:
    """Light on the folds, beside the corners of the mouth."""
    return float(np.mean([rgb[y, x] for x, y in (fold(-1)[1], fold(1)[1])]))


def test_a_mouth_as_wide_as_in_its_picture_keeps_its_folds() -> None:
    for share in (-0.2, 0.0, 0.04):
        np.testing.assert_array_equal(eased(picture(), share), picture())


def test_a_mouth_a_sixth_narrower_has_none() -> None:
    """They are within a sixth of the skin's light again, half-way by half; lips and the skin further away stay."""
    skin, dark = float(np.mean(SKIN)), on_folds(picture())
    half, whole = eased(picture(), 0.1), eased(picture(), 0.16)
    assert on_folds(whole) > skin - (skin - dark) / 6
    assert on_folds(half) == pytest.approx((on_folds(whole) + dark) / 2, abs=2)
    lips = np.zeros(SIZE[::-1], np.uint8)
    cv2.fillPoly(lips, [FACE[list(LIPS_OUTER), :2].round().astype(np.int32)], 1)
    away = np.ones(SIZE[::-1], np.uint8)
    cv2.fillPoly(away, [FACE[list(FACE_OVAL), :2].round().astype(np.int32)], 0)
    away[: int(FACE[4, 1])] = 1
    change = np.abs(whole.astype(int) - picture()).max(axis=2)
    assert change[cv2.erode(lips, np.ones((3, 3))) > 0].max() <= 1 and change[away > 0].max() == 0
    assert (whole <= np.array(SKIN) + 1).all(), "no lighter than the skin is"


def test_a_moustache_stays() -> None:
    hairy = picture(moustache=True)
    np.testing.assert_array_equal(eased(hairy, 0.25), hairy)


def test_turns_aside_shorten_mouth_and_eyes_alike() -> None:
    turned = placed(60.0, (150.0, 130.0), yaw=20)
    assert mouth_width(turned) == pytest.approx(mouth_width(FACE), rel=0.04)


def test_a_thin_line_at_a_corner_goes_too_with_its_ridge_and_what_grows_in_the_middle_stays() -> None:
    """Lines as thin as grain would stay as hooks beside the mouth; a mole on the chin and the groove below the nose are no folds."""
    rgb = picture()
    corner = FACE[291, :2].round().astype(int)
    line = np.linspace(corner + np.array([4, 1]), corner + np.array([14, 6]), 12).round().astype(int)
    for shift, colour in ((0, FOLD), (3, (235, 205, 190))):
        cv2.polylines(rgb, [(line + np.array([0, shift])).astype(np.int32)], False, colour, 1, cv2.LINE_AA)
    groove, mole = (
        FACE[[2, 0], :2].mean(axis=0).round().astype(int),
        FACE[[17, 152], :2].mean(axis=0).round().astype(int),
    )
    for place in (groove, mole):
        cv2.circle(rgb, place.tolist(), 3, FOLD, -1, cv2.LINE_AA)
    whole = eased(rgb, 0.25)
    for shift in (0, 3):
        there = whole[line[:, 1] + shift, line[:, 0]].mean(axis=1)
        assert np.abs(there - np.mean(SKIN)).max() < 12, "the skin's light again"
    for x, y in (groove, mole):
        np.testing.assert_array_equal(whole[y - 3 : y + 4, x - 3 : x + 4], rgb[y - 3 : y + 4, x - 3 : x + 4])
