"""Where eyes look: both one way, to their corners together and no further, and shut ones do not count."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from made_face import painted, placed, shut
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import Eyeball, prepare_eyes
from engine.face_animation.eyes.eyes import draw_eye
from engine.face_animation.eyes.gaze import (
    CARUNCLE_EYE_WIDTHS,
    MIN_CORNER_DISTANCE_IRIS_RADII,
    MIN_VERGENCE_IRIS_RADII,
    conjugate,
    gaze,
    iris_positions,
    iris_radii,
    iris_shifts,
)
from engine.perception.face.landmarks import LEFT_IRIS, RIGHT_IRIS

SIZE = (360, 320)
TO_THE_RIGHT = np.array([[1.0, 0.0], [-1.0, 0.0]])
"""A look along the picture, of a radius of the iris."""
OPEN = np.ones((1, 2))
EYES = ((33, 133, RIGHT_IRIS), (263, 362, LEFT_IRIS))
"""Outer corner, inner corner and iris of both, right eye first."""


@pytest.fixture(scope="module")
def mesh() -> NDArray[np.float32]:
    return shut(placed(120, (180, 140)), 1.6)


@pytest.fixture(scope="module")
def eyes(mesh: NDArray) -> tuple[Eyeball, Eyeball]:
    right, left = prepare_eyes(painted(mesh, SIZE), mesh)
    assert right is not None and left is not None
    return right, left


def irises_moved(mesh: NDArray, right: float, left: float) -> NDArray[np.float32]:
    """A mesh whose irises have moved along the picture, pixels."""
    moved = mesh.copy()
    moved[list(RIGHT_IRIS), 0] += right
    moved[list(LEFT_IRIS), 0] += left
    return moved


def test_radii_and_places_of_irises_in_eye_widths(mesh: NDArray) -> None:
    for side, (outer, inner, iris) in enumerate(EYES):
        width = np.linalg.norm(mesh[outer, :2] - mesh[inner, :2])
        rim = np.linalg.norm(mesh[iris[1], :2] - mesh[iris[0], :2])
        assert iris_radii(mesh[None])[0, side] == pytest.approx(rim / width, rel=0.05)
    before, after = iris_positions(np.stack([mesh, irises_moved(mesh, 6, 6)]))
    width = np.linalg.norm(mesh[33, :2] - mesh[133, :2])
    np.testing.assert_allclose((after - before)[:, 0] * width, [6, -6], rtol=0.05)  # outer to inner: right, and left


def shifted(eyes: tuple[Eyeball, Eyeball], look: NDArray) -> list[NDArray[np.float64]]:
    """How far both irises go, in eye widths."""
    return [shift for shift in iris_shifts(eyes, look) if shift is not None]


def test_the_target_looks_as_the_driver_does_where_both_are_alike(mesh: NDArray, eyes: tuple[Eyeball, Eyeball]) -> None:
    shifts = shifted(eyes, gaze(irises_moved(mesh, 5, 5)[None], mesh, OPEN)[0])
    for shift, (outer, inner, _) in zip(shifts, EYES, strict=True):
        along = (mesh[inner, :2] - mesh[outer, :2]) * shift[0]
        np.testing.assert_allclose(along, [5, 0], atol=0.8)  # irises of the made face rest unevenly


def test_small_irises_go_less_far(mesh: NDArray, eyes: tuple[Eyeball, Eyeball]) -> None:
    """A look is an angle: an iris half as large goes half as far before the same eye's white."""
    look = gaze(irises_moved(mesh, 4, 4)[None], mesh, OPEN)[0]
    small = (replace(eyes[0], radius=eyes[0].radius / 2), replace(eyes[1], radius=eyes[1].radius / 2))
    np.testing.assert_allclose(
        np.sum([abs(shift) for shift in shifted(small, look)], axis=0),
        np.sum([abs(shift) for shift in shifted(eyes, look)], axis=0) / 2,
        rtol=0.02,
    )


def test_gaze_does_not_see_the_head_move(mesh: NDArray) -> None:
    a = np.deg2rad(20)
    turned = 1.3 * (mesh[:, :2] - 180) @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) + 90
    np.testing.assert_allclose(gaze(turned[None], mesh[:, :2], OPEN)[0], 0, atol=1e-5)


def test_irises_that_rest_apart_come_to_their_corners_together(mesh: NDArray, eyes: tuple[Eyeball, Eyeball]) -> None:
    """Of a face whose irises rest unevenly none looks at its corner while the other looks ahead, and both go as far as they are told in their mean. The inner
    corner begins at the caruncle, which no iris covers."""
    right, left = eyes
    uneven = (replace(right, centre=np.array([-0.1, 0.0])), replace(left, centre=np.array([-0.1, 0.0])))
    for far in (9.0, -9.0):
        for eye, shift, sign in zip(uneven, shifted(uneven, far * TO_THE_RIGHT), (1, -1), strict=True):
            end = 0.5 - CARUNCLE_EYE_WIDTHS if sign * far > 0 else 0.5
            corner = np.sign(sign * far) * (end - MIN_CORNER_DISTANCE_IRIS_RADII * eye.radius)
            assert eye.centre[0] + shift[0] == pytest.approx(corner)
    little = [shift[0] for shift in shifted(uneven, 0.3 * TO_THE_RIGHT)]
    ways = [
        end - MIN_CORNER_DISTANCE_IRIS_RADII * eye.radius - sign * -0.1
        for eye, sign, end in zip(uneven, (1, -1), (0.5 - CARUNCLE_EYE_WIDTHS, 0.5), strict=True)
    ]
    assert little[0] > 0 > little[1]
    assert little[0] / -little[1] == pytest.approx(ways[0] / ways[1])
    radius = np.mean([eye.radius * eye.width for eye in uneven])
    assert np.mean([abs(way) * eye.width for way, eye in zip(little, uneven, strict=True)]) == pytest.approx(
        0.3 * radius
    )


def test_people_s_irises_go_alike_far_when_they_glance_aside(eyes: tuple[Eyeball, Eyeball]) -> None:
    """An iris is 11.7 mm across, an eye 30 mm wide, with a caruncle of 3 to 4 mm, and rests in the middle of what is left: it is as far to either side."""
    usual = tuple(replace(eye, centre=np.array([-0.06, 0.0]), radius=0.195, width=eyes[0].width) for eye in eyes)
    for far in (9.0, -9.0):
        right, left = shifted((usual[0], usual[1]), far * TO_THE_RIGHT)
        assert right[0] == pytest.approx(-left[0], rel=0.2)


def test_an_eye_without_an_eyeball_is_left_out(eyes: tuple[Eyeball, Eyeball]) -> None:
    alone = iris_shifts((eyes[0], None), 0.3 * TO_THE_RIGHT)
    assert alone[1] is None and alone[0] is not None
    assert alone[0][0] == pytest.approx(0.3 * eyes[0].radius)
    assert iris_shifts((None, None), TO_THE_RIGHT) == [None, None]


def test_a_large_iris_that_rests_in_its_corner_still_moves(eyes: tuple[Eyeball, Eyeball]) -> None:
    large = (
        replace(eyes[0], centre=np.array([0.4, 0.0]), radius=0.3),
        replace(eyes[1], centre=np.array([-0.4, 0.0]), radius=0.3),
    )
    right, left = shifted(large, TO_THE_RIGHT)
    assert right[0] > 0 > left[0]


def test_eyes_look_the_same_way_but_where_they_are_crossed() -> None:
    """A tracker that has one iris go further than the other errs; irises that both go far inwards are meant."""
    one_errs = np.array([[[0.4, -0.04], [-0.2, 0.0]]])
    np.testing.assert_allclose(conjugate(one_errs, OPEN), [[[0.3, -0.02], [-0.3, 0.02]]], atol=1e-6)
    crossed = np.array([[[0.9, 0.0], [0.9, 0.0]]])
    np.testing.assert_allclose(conjugate(crossed, OPEN), crossed - np.array([MIN_VERGENCE_IRIS_RADII, 0.0]), atol=1e-6)


def test_nobody_looks_up_with_one_eye_and_down_with_the_other() -> None:
    skewed = np.array([[[0.0, 0.9], [0.0, 0.9]]])  # across each eye: down the picture, and up
    np.testing.assert_allclose(conjugate(skewed, OPEN), 0, atol=1e-9)


def test_an_eye_that_shuts_does_not_lead_the_other() -> None:
    """Its iris is not seen; and where both are shut nobody looks anywhere."""
    looks = np.array([[[0.5, 0.0], [0.8, 0.0]]])
    winking = conjugate(looks, np.array([[1.0, 0.0]]))
    np.testing.assert_allclose(winking, [[[0.5, 0.0], [-0.5, 0.0]]], atol=1e-5)
    np.testing.assert_allclose(conjugate(looks, np.zeros((1, 2))), 0)


def test_the_measured_gaze_is_the_drawn_one(mesh: NDArray, eyes: tuple[Eyeball, Eyeball]) -> None:
    """The iris of a drawn eye stands where the driver's does, measured in the picture: its brown is there."""
    picture = painted(mesh, SIZE)
    shifts = shifted(eyes, gaze(irises_moved(mesh, 5, 5)[None], mesh, OPEN)[0])
    for side, (_, _, iris) in enumerate(EYES):
        out = picture.copy()
        draw_eye(out, eyes[side], mesh, side, shifts[side])
        box = np.zeros(picture.shape[:2], np.uint8)
        centre = mesh[iris[0], :2]
        cv2.circle(box, tuple(int(v) for v in np.rint(centre)), 22, 1, -1)
        change = (out.astype(int) - picture).sum(axis=2) * box
        xs = np.mgrid[: box.shape[0], : box.shape[1]][1]
        gone, come = (change > 60), (change < -60)
        assert xs[come].mean() > xs[gone].mean(), "it goes to the picture's right"
