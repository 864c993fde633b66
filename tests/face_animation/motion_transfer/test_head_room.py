"""How far a head may go in its picture, and motion held back to that."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import placed, turn
from numpy.typing import NDArray

from engine.face_animation.motion_transfer.alignment import align
from engine.face_animation.motion_transfer.head_motion import HeadMotion, split_motion, turn_angles
from engine.face_animation.motion_transfer.head_room import (
    FACE_SIDE_SLANT_RADIANS,
    FREE_ROOM_SHARE,
    MAX_STRETCH_RATIO,
    MAX_TURN_RADIANS,
    MIN_TURN_RADIANS,
    cut_above,
    face_room,
    head_room,
    hold_back,
    limit_rotation,
    max_counter_rotation,
    skull_shift,
    soft_limit,
)
from engine.perception.face.landmarks import FACE_OVAL

UNIT, CENTRE = 40.0, (150.0, 150.0)


@pytest.fixture(scope="module")
def face() -> NDArray[np.float32]:
    return placed(UNIT, CENTRE)


def test_a_head_that_nothing_cuts_may_go_as_far_as_its_face_stays_in_the_picture(face: NDArray) -> None:
    person = np.zeros((300, 340), np.float32)
    person[40:300, 80:220] = 1
    room = head_room(face, person)
    oval = face[list(FACE_OVAL), :2]
    np.testing.assert_allclose(room[0], -oval.min(axis=0), atol=1e-4)
    np.testing.assert_allclose(room[1], np.array([339, 299]) - oval.max(axis=0), atol=1e-4)


def test_what_of_a_head_is_cut_above_is_told_across_its_face(face: NDArray) -> None:
    left, right = (int(edge(face[list(FACE_OVAL), 0])) for edge in (np.min, np.max))
    person = np.zeros((300, 300), np.float32)
    person[40:, 80:220] = 1
    assert cut_above(face, person) == 0
    person[:, left : (left + right) // 2] = 1
    assert cut_above(face, person) == pytest.approx(0.5, abs=0.03)


def test_hair_that_the_border_cuts_comes_down_by_a_part_of_it(face: NDArray) -> None:
    free, cut = np.zeros((300, 300), np.float32), np.zeros((300, 300), np.float32)
    free[40:, 80:220] = 1
    cut[:, 80:220] = 1
    cut[0] = 0  # a thin frame hides no cut
    assert head_room(face, cut)[1, 1] < 0.5 * face[10, 1] < head_room(face, free)[1, 1]
    np.testing.assert_array_equal(head_room(face, cut)[0], head_room(face, free)[0])


def test_what_there_is_room_for_is_kept_and_nothing_goes_beyond() -> None:
    low, high = np.array([-10.0]), np.array([40.0])
    kept = np.array([[-10 * FREE_ROOM_SHARE], [0.0], [40 * FREE_ROOM_SHARE]])
    np.testing.assert_allclose(soft_limit(kept, low, high), kept)
    asked = np.linspace(-300, 300, 2001)[:, None]
    held = soft_limit(asked, low, high)
    assert held.min() >= -10 and held.max() <= 40
    steps = np.diff(held[:, 0])
    assert (steps >= 0).all() and np.abs(np.diff(steps)).max() < 0.05  # smoothly


def moved(face: NDArray, rotation: NDArray, shift: tuple[float, float, float]) -> HeadMotion:
    middle = face.mean(axis=0)
    return split_motion(((face - middle) @ rotation.T + middle + np.array(shift))[None], face)


def test_small_motion_is_not_held_back(face: NDArray) -> None:
    motion = moved(face, turn(yaw=8, roll=5), (6, -4, 0))
    held = hold_back(motion, align(face, face), np.array([[-90, -90], [90, 90]]))
    np.testing.assert_allclose(held.rotation, motion.rotation, atol=1e-9)
    np.testing.assert_allclose(held.shift, motion.shift, atol=1e-6)


def test_large_motion_saturates_and_the_expression_stays(face: NDArray) -> None:
    """The driver's face is half as large as the target's: room is counted in the target."""
    driver = placed(UNIT / 2, (80.0, 80.0))
    motion = moved(driver, turn(yaw=60), (200, -90, 0))
    phi = align(driver, face)
    held = hold_back(motion, phi, np.array([[-50, -20], [50, 20]]))
    shift = phi.offsets(skull_shift(held)[0, :2])
    assert 40 < shift[0] <= 50 and -20 <= shift[1] < -15
    turned = held.rotation[0] @ driver.T
    assert turn_angles(turned.T[None], driver)[0] <= MAX_TURN_RADIANS + 1e-6
    np.testing.assert_array_equal(held.expression, motion.expression)


@pytest.mark.parametrize("yaw", [-25.0, 0.0, 25.0])
def test_a_face_stays_in_the_picture_however_it_is_turned(face: NDArray, yaw: float) -> None:
    """A turn carries the face on beyond where the skull goes; near rest nothing is held back."""
    size, oval = (320, 320), list(FACE_OVAL)
    room, wide = face_room(face, size), np.array([[-900, -900], [900, 900]])
    for shift in ((90, 40, 0), (-90, -60, 0)):
        held = hold_back(moved(face, turn(yaw=yaw), shift), align(face, face), wide, face=room)
        placed_so = held.scale[0] * face[oval] @ held.rotation[0].T + held.shift[0]
        assert (placed_so[:, :2] >= 0).all() and (placed_so[:, :2] <= np.array(size) - 1).all()
    little = moved(face, turn(yaw=yaw / 5), (3, -2, 0))
    np.testing.assert_allclose(hold_back(little, align(face, face), wide, face=room).shift, little.shift, atol=1e-6)


@pytest.mark.parametrize("turned", [0.0, 10.0, 20.0, 30.0])
def test_a_face_that_turns_back_stretches_its_far_side_by_so_much(turned: float) -> None:
    """A patch that slants by an angle is as wide as its cosine; it cannot be wider than seen from the front."""
    own = np.deg2rad(turned)
    stretch = np.cos(FACE_SIDE_SLANT_RADIANS + own - max_counter_rotation(own)) / np.cos(FACE_SIDE_SLANT_RADIANS + own)
    assert stretch == pytest.approx(min(MAX_STRETCH_RATIO, 1 / np.cos(FACE_SIDE_SLANT_RADIANS + own)))


@pytest.mark.parametrize("turned", [-40.0, -20.0, 0.0, 20.0, 60.0])
def test_turns_end_where_the_picture_shows_no_more(turned: float) -> None:
    """Of a face that is turned about y, to either side; and they never fall back."""
    own = float(np.deg2rad(turned))
    for side in (-1, 1):
        wanted = np.deg2rad(side * np.linspace(0, 60, 25))
        rotations = np.stack([cv2.Rodrigues(np.array([0.0, angle, 0.0]))[0] for angle in wanted])
        held = side * np.array([cv2.Rodrigues(r)[0][1, 0] for r in limit_rotation(rotations, (0.0, own))])
        assert (np.diff(held) > -1e-6).all()
        most = min(max_counter_rotation(abs(own)), MAX_TURN_RADIANS) if side * own < 0 else MAX_TURN_RADIANS - abs(own)
        assert held[-1] <= max(most, MIN_TURN_RADIANS) + 1e-6
