"""Teeth of one photograph in a mouth that moves."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from engine.face_animation.mouth.modelled.resting_mouth import resting_mouth
from engine.face_animation.mouth.modelled.skull import skull_camera
from engine.face_animation.mouth.pictured.photo_teeth import PhotoTeeth, appearing_opening
from engine.face_animation.mouth.pictured.pictured_face import PicturedFace
from engine.face_animation.mouth.pictured.teeth_strip import teeth_strip, without_violet
from engine.perception.expression.features import frontalise
from engine.perception.face.head_pose import canonical_face
from engine.perception.face.landmarks import LIPS_INNER, LIPS_OUTER, RIGID_VERTICES

SKIN = (190, 150, 130)
CAVITY = np.array([50.0, 20.0, 20.0])
LOWER = [146, 91, 181, 84, 17, 314, 405, 321, 375, 95, 88, 178, 87, 14, 317, 402, 318, 324, 148, 152, 377]


def face(gap: float, eyes: float = 80.0, middle: tuple[float, float] = (160.0, 150.0)) -> np.ndarray:
    """(478, 3) pixels, the lower lip and the chin `gap` eye distances down."""
    mesh = canonical_face().astype(np.float64)
    mesh -= mesh[list(RIGID_VERTICES)].mean(axis=0)
    mesh /= np.linalg.norm(mesh[[33, 133]].mean(axis=0) - mesh[[263, 362]].mean(axis=0))
    mesh[LOWER, 1] += gap
    return (mesh * eyes + (*middle, 0)).astype(np.float32)


def picture(mesh: np.ndarray) -> np.ndarray:
    """Skin, red lips, and between them striped teeth above, dark below."""
    rgb = np.full((320, 320, 3), SKIN, np.uint8)
    cv2.fillPoly(rgb, [np.rint(mesh[list(LIPS_OUTER), :2]).astype(np.int32)], (170, 70, 80))
    inner = np.zeros((320, 320), np.uint8)
    cv2.fillPoly(inner, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], 1)
    rows, columns = np.nonzero(inner)
    upper = rows < mesh[13, 1] + 0.6 * (mesh[14, 1] - mesh[13, 1])
    rgb[rows, columns] = CAVITY
    rgb[rows[upper], columns[upper]] = (225, 215, 200)
    stripe = upper & (columns % 8 < 2)
    rgb[rows[stripe], columns[stripe]] = (150, 135, 120)
    return rgb


class Dark:
    """The inside of an open mouth, of one colour."""

    def draw(self, frame: np.ndarray, face: np.ndarray, driver_frame: int) -> None:
        if face[14, 1] - face[13, 1] > 2:
            cv2.fillPoly(frame, [np.rint(face[list(LIPS_INNER), :2]).astype(np.int32)], CAVITY.tolist())


@pytest.fixture(scope="module")
def mouth() -> PhotoTeeth:
    smile, rest = face(0.14), face(0.0)
    at = resting_mouth(frontalise(rest[None])[0], frontalise(rest[None])[0])
    faces = np.array([face(0.2)[:, :2], rest[:, :2]])
    return PhotoTeeth(
        at, picture(rest), rest, PicturedFace(picture(smile), smile), Dark(), faces, appearing_opening(rest)
    )


def test_the_skull_is_found_whatever_the_mouth_does() -> None:
    shut, open_wide = (skull_camera(face(0.0) / 80, face(gap)[:, :2]) for gap in (0.0, 0.4))
    np.testing.assert_allclose(shut[0], open_wide[0], atol=1e-3)
    np.testing.assert_allclose(shut[0], 80 * np.eye(3)[:2], atol=1e-2)


def test_upper_teeth_stay_in_the_skull_where_the_mouth_opens(mouth: PhotoTeeth) -> None:
    corner, shape = np.array([130.0, 170.0]), (60, 60)
    before, after = (mouth.places(face(gap), corner, shape) for gap in (0.1, 0.3))
    np.testing.assert_allclose(before, after, atol=0.002)


def test_rounded_lips_cover_what_they_are_pushed_before(mouth: PhotoTeeth) -> None:
    """A mouth that is 0.3 narrower than at rest covers 0.6 of what that is beyond a twentieth."""
    corner, shape = np.array([130.0, 170.0]), (60, 60)
    said = face(0.2)
    before = mouth.places(said, corner, shape)
    lips = sorted({*LIPS_INNER, *LIPS_OUTER})
    said[lips, 0] = said[lips, 0].mean() + 0.7 * (said[lips, 0] - said[lips, 0].mean())
    after = mouth.places(said, corner, shape)
    np.testing.assert_allclose(after[..., 0], before[..., 0], atol=0.002)
    np.testing.assert_allclose(after[..., 1] - before[..., 1], 0.6 * (0.3 - 0.05), atol=0.006)


def test_they_end_higher_where_the_driver_shows_less_of_them(mouth: PhotoTeeth) -> None:
    corner, shape = np.array([130.0, 170.0]), (60, 60)
    said = face(0.2)
    whole, less, none = (mouth.places(said, corner, shape, shown)[..., 1] for shown in (1.0, 0.1, 0.0))
    assert (less > whole + 0.005).all() and (none > less).all()


@pytest.mark.parametrize(("degrees", "scale"), [(0, 1.0), (20, 1.0), (-15, 1.3)])
def test_teeth_go_where_the_head_goes(mouth: PhotoTeeth, degrees: float, scale: float) -> None:
    angle = np.radians(degrees)
    turn = scale * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    rest = face(0.2)
    moved = rest.copy()
    moved[:, :2] = rest[:, :2] @ turn.T + (12.0, -7.0)
    point = rest[13, :2] + (2.0, 8.0)
    one, other = (mouth.places(*pair, (1, 1))[0, 0] for pair in ((rest, point), (moved, point @ turn.T + (12.0, -7.0))))
    np.testing.assert_allclose(one, other, atol=0.002)


def test_below_the_upper_teeth_is_what_is_behind_them(mouth: PhotoTeeth) -> None:
    wide = face(0.35)
    frame = picture(face(0.0))
    mouth.draw(frame, wide[:, :2], 0)
    x, top, bottom = int(wide[13, 0]), int(wide[13, 1]), int(wide[14, 1])
    column = frame[top:bottom, x - 8 : x + 8].mean(axis=(1, 2))
    assert column[: len(column) // 4].max() > 120 > 2 * CAVITY.mean(), "teeth below the upper lip"
    np.testing.assert_array_equal(frame[bottom - 6, x], CAVITY)
    ends = int(np.flatnonzero(column > 100)[-1])
    assert 0.15 < ends / len(column) < 0.7, "they end where the skull has them, however wide the mouth"


def test_it_is_drawn_between_the_lips_alone_and_only_where_they_part(mouth: PhotoTeeth) -> None:
    for gap, drawn in ((0.0, False), (0.25, True)):
        mesh = face(gap)
        frame = np.full((320, 320, 3), 128, np.uint8)
        mouth.draw(frame, mesh[:, :2], 0)
        changed = (frame != 128).any(axis=-1)
        inner = np.zeros(frame.shape[:2], np.uint8)
        cv2.fillPoly(inner, [np.rint(mesh[list(LIPS_INNER), :2]).astype(np.int32)], 1)
        assert changed.any() == drawn
        assert not changed[cv2.dilate(inner, np.ones((9, 9), np.uint8)) == 0].any()


def test_a_white_band_shows_no_crowns() -> None:
    smile = face(0.14)
    striped = picture(smile)
    band = striped.copy()
    band[(striped == (150, 135, 120)).all(axis=-1)] = (225, 215, 200)
    crowns = [teeth_strip(PicturedFace(rgb, smile), 80.0).crowns() for rgb in (striped, band)]
    assert crowns[1] < 0.04 < 0.1 < crowns[0]


def test_no_tooth_is_violet_and_all_are_as_light_as_they_were() -> None:
    seam, enamel, gum = (190.0, 150.0, 200.0), (225.0, 215.0, 200.0), (170.0, 70.0, 70.0)
    found = without_violet(np.array([seam, enamel, gum]))
    weights = np.array([0.299, 0.587, 0.114])
    np.testing.assert_allclose(found @ weights, np.array([seam, enamel, gum]) @ weights, rtol=1e-4)
    np.testing.assert_allclose(found[1:], (enamel, gum), rtol=1e-4)
    assert found[0, 2] <= found[0, 1]
