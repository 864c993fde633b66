"""Lids that close are skin down to their edge, and pass into the picture's skin all around."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, painted, placed, shut

from engine.face_animation.eyes.eyeball import prepare_eyes
from engine.face_animation.eyes.eyes import lid_closing_share, shut_share
from engine.face_animation.eyes.lid import CREASE_PLACE_SHARE, draw_lid
from engine.face_animation.eyes.socket_frame import UPPER_LID_STRIPS, SocketFrame, socket_frame
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE

FACE = placed(160, (250, 200))
SIZE = (500, 600)
PLAIN = np.full((4, 9, 3), SKIN, np.float32)


def column(socket: SocketFrame, ways: np.ndarray) -> np.ndarray:
    """(K, 2) the pixels of a lid's middle at `ways` (K,) from the socket's top to the lid's edge."""
    middle = np.full(len(ways), 0.5)
    top, _ = socket.ends(middle)
    return np.rint(socket.pixels(middle, top + ways * (socket.rim(middle) - top))).astype(int)


@pytest.mark.parametrize("side", [0, 1])
def test_nothing_of_an_eye_is_left_where_lids_have_met(side: int) -> None:
    """Of an eye that is larger in the picture than in the mesh, above, below and beyond the corners."""
    closed = shut(FACE, 0.02)
    frame = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    outer, inner = ((33, 133), (263, 362))[side]
    line = closed[[outer, *UPPER_LID_STRIPS[side][1], inner], :2].round().astype(np.int32)
    cv2.polylines(frame, [line], False, (255, 255, 255), 7)
    draw_lid(frame, PLAIN, socket_frame(closed, side), 1.0, 1.0)
    assert (frame <= np.array(SKIN) * 1.1).all()


@pytest.mark.parametrize("side", [0, 1])
def test_what_is_still_open_stays_as_it_is(side: int) -> None:
    half = shut(FACE, 0.5)
    frame = painted(half, SIZE)
    before = frame.copy()
    draw_lid(frame, PLAIN, socket_frame(half, side), 1.0, 0.0)
    opening = np.zeros(frame.shape[:2], np.uint8)
    cv2.fillPoly(opening, [half[list((RIGHT_EYE, LEFT_EYE)[side]), :2].round().astype(np.int32)], 1)
    still = cv2.erode(opening, np.ones((9, 9))) > 0
    assert still.sum() > 50
    np.testing.assert_array_equal(frame[still], before[still])
    other = socket_frame(half, 1 - side).pixels(np.array(0.5), np.array(0.0)).round().astype(int)
    np.testing.assert_array_equal(frame[other[1], other[0]], before[other[1], other[0]])
    draw_lid(frame, PLAIN, socket_frame(half, side), 0.0, 0.0)


def test_no_share_of_a_lid_is_the_picture() -> None:
    frame = painted(FACE, SIZE)
    before = frame.copy()
    draw_lid(frame, 0 * PLAIN, socket_frame(FACE, 0), 0.0, 0.0)
    np.testing.assert_array_equal(frame, before)


@pytest.mark.parametrize("side", [0, 1])
def test_a_lid_has_no_outline(side: int) -> None:
    """By hand: from white to the black of a lid within a fifth of an eye width at least, so no pixel differs by more from its neighbours than the
    steepest smoothstep of that width, but at the lid's edge over the open eye."""
    closed = shut(FACE)
    frame = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8)
    socket = socket_frame(closed, side)
    draw_lid(frame, 0 * PLAIN, socket, 1.0, 1.0)
    assert frame.min() < 5
    steepest = max(np.abs(np.diff(frame[..., 0].astype(int), axis=axis)).max() for axis in (0, 1))
    assert steepest < 1.5 * 255 / (0.12 * socket.width)


@pytest.mark.parametrize("side", [0, 1])
def test_its_edge_ends_at_the_corners(side: int) -> None:
    """Beyond them, as far as lids are thick, skin passes into skin, however far an eye is open."""
    half = shut(FACE, 0.5)
    frame = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8)
    socket = socket_frame(half, side)
    draw_lid(frame, 0 * PLAIN, socket, 1.0, 0.0)
    for along in (-0.15, 1.1):
        x, y = np.rint(socket.pixels(np.full(60, along), np.linspace(-0.3, 0.3, 60))).astype(int).T
        assert np.abs(np.diff(frame[y, x, 0].astype(int))).max() < 40


def test_a_lid_lies_over_a_ball_below_its_crease() -> None:
    closed = shut(FACE)
    frame = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    socket = socket_frame(closed, 0)
    draw_lid(frame, PLAIN, socket, 1.0, 0.0)
    x, y = column(socket, np.array([CREASE_PLACE_SHARE, (1 + CREASE_PLACE_SHARE) / 2, 0.97])).T
    crease, ball, edge = frame[y, x].mean(axis=1)
    assert crease < 0.97 * ball and edge < 0.97 * ball


def test_it_begins_where_the_lid_begins_to_close_and_ends_as_the_eye_is_shut() -> None:
    for side, eye in enumerate(prepare_eyes(painted(FACE, SIZE), FACE)):
        assert eye is not None
        faces = [shut(FACE, share)[:, :2] for share in (1.0, 0.87, 0.6, 0.4, 0.2, 0.0)]
        closing, closed = ([share(eye, face, side) for face in faces] for share in (lid_closing_share, shut_share))
        assert closing[0] == 0 and closing[-2:] == [1, 1] and (np.diff(closing) >= 0).all() and 0 < closing[1] < 1
        assert closed[:4] == [0, 0, 0, 0] and closed[-1] == 1 and 0 < closed[4] < 1


def test_a_face_at_the_picture_s_edge_is_drawn_as_far_as_it_goes() -> None:
    face = FACE - np.float32([250, 170, 0])
    frame = np.full((100, 120, 3), 200, np.uint8)
    for side in (0, 1):
        draw_lid(frame, 0 * PLAIN + 50, socket_frame(face, side), 1.0, 1.0)
    assert frame.min() < 100
