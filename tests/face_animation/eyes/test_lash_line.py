"""Lashes are a line at the edge of a lid, as dark and as wide as the picture's, and tapered to both corners."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, painted, placed, shut

from engine.face_animation.eyes.lash_line import LASH_WIDTH_RANGE_EYE_WIDTHS, Lashes, draw_lashes, upper_lashes
from engine.face_animation.eyes.socket_frame import socket_frame

FACE = placed(160, (250, 200))
SIZE = (500, 600)
BLACK = np.array([10, 10, 10], np.float32)


@pytest.mark.parametrize("side", [0, 1])
def test_a_shut_eye_has_a_line_along_its_rim_and_nothing_else(side: int) -> None:
    socket = socket_frame(shut(FACE), side)
    frame = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    draw_lashes(frame, Lashes(BLACK, 0.06), socket, 1.0)
    share = (frame.astype(float) - SKIN) @ (BLACK - SKIN) / float((BLACK - SKIN) @ (BLACK - SKIN))
    np.testing.assert_allclose(frame, SKIN + share[..., None] * (BLACK - SKIN), atol=2)
    ys, xs = np.nonzero(share > 0.1)
    along, down = socket.of_pixels(xs, ys)
    assert np.abs(down - socket.rim(along)).max() < 0.1 and along.min() > -0.05 and along.max() < 1.05
    for place, wide in ((0.5, 0.06), (1 / 6, 0.03)):  # by hand: a sine from corner to corner
        near = np.abs(socket.of_pixels(*np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])))[0] - place) < 0.06
        assert share[near].sum() / (0.12 * socket.width**2) == pytest.approx(wide, rel=0.2)


def test_no_share_of_it_is_the_picture() -> None:
    frame = painted(FACE, SIZE)
    before = frame.copy()
    draw_lashes(frame, Lashes(BLACK, 0.06), socket_frame(FACE, 0), 0.0)
    np.testing.assert_array_equal(frame, before)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("wide", [0.055, 0.075])
def test_it_is_as_dark_and_as_wide_as_the_picture_s(side: int, wide: float) -> None:
    picture, socket = painted(FACE, SIZE), socket_frame(FACE, side)
    t = np.linspace(0, 1, 30)
    band = np.concatenate([socket.pixels(t, socket.rim(t) + 0.01), socket.pixels(t, socket.rim(t) - wide)[::-1]])
    cv2.fillPoly(picture, [np.round(band * 16).astype(np.int32)], BLACK.tolist(), cv2.LINE_AA, 4)
    lashes = upper_lashes(picture, socket)
    np.testing.assert_allclose(lashes.colour, BLACK, atol=12)
    assert lashes.width == pytest.approx(wide, abs=0.012)


def test_a_bare_edge_has_a_thin_line_and_a_socket_in_the_dark_no_broad_one() -> None:
    socket = socket_frame(FACE, 0)
    assert upper_lashes(painted(FACE, SIZE), socket).width == LASH_WIDTH_RANGE_EYE_WIDTHS[0]
    dark = painted(FACE, SIZE)
    dark[: int(FACE[145, 1])] = 20
    assert upper_lashes(dark, socket).width <= LASH_WIDTH_RANGE_EYE_WIDTHS[1]
