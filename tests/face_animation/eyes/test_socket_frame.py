"""The socket of an eye lies between brow and cheek, and is told along the eye and down, whichever side it is on."""

from __future__ import annotations

import numpy as np
import pytest
from made_face import placed, shut

from engine.face_animation.eyes.socket_frame import EYE_CORNER_VERTEX_PAIRS, socket_frame

FACES = (placed(160, (250, 200)), placed(120, (250, 200), roll=25))


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("side", [0, 1])
def test_places_are_from_the_outer_corner_to_the_inner_one_and_down(face: np.ndarray, side: int) -> None:
    frame = socket_frame(face, side)
    corners = face[list(EYE_CORNER_VERTEX_PAIRS[side]), :2]
    np.testing.assert_allclose(frame.of_pixels(*corners.T), [[0, 1], [0, 0]], atol=1e-5)
    along = np.linspace(0.1, 0.9, 5)
    top, bottom = frame.ends(along)
    assert (top < frame.rim(along)).all() and (frame.rim(along) < bottom).all()


@pytest.mark.parametrize("side", [0, 1])
def test_pixels_are_where_their_places_are(side: int) -> None:
    frame = socket_frame(FACES[1], side)
    along, down = np.random.default_rng(0).uniform(-0.5, 1.5, (2, 4, 7))
    np.testing.assert_allclose(
        frame.of_pixels(*np.moveaxis(frame.pixels(along, down), -1, 0)), (along, down), atol=1e-9
    )


def test_the_rim_goes_down_as_the_lid_does_and_the_socket_stays() -> None:
    for side in range(2):
        before, after = socket_frame(FACES[0], side), socket_frame(shut(FACES[0]), side)
        middle = np.array([0.5])
        assert after.rim(middle)[0] > before.rim(middle)[0] + 0.15
        assert after.rim(middle)[0] == pytest.approx(np.interp(0.5, *before.lower.T), abs=0.02)
        np.testing.assert_allclose(after.ends(middle), before.ends(middle), atol=1e-6)


def test_a_box_is_within_the_picture() -> None:
    low, high = socket_frame(FACES[0] - np.float32([250, 170, 0]), 0).box((100, 120, 3))
    assert low.min() >= 0 and (high <= (120, 100)).all()
