"""The skin of a socket is made of the skin around the eye: nothing of the eye, its lashes or its shadow is in it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, painted, placed
from numpy.typing import NDArray

from engine.face_animation.eyes.socket_frame import UPPER_LID_STRIPS, socket_frame
from engine.face_animation.eyes.socket_skin import (
    CHEEK_BELOW_LID_VERTICES,
    MAX_GRAIN_GREY_LEVELS,
    beside_the_eye,
    socket_places,
    socket_skin,
)
from engine.perception.face.landmarks import LEFT_EYE, RIGHT_EYE

FACE = placed(160, (250, 200))
SIZE = (500, 600)
BLACK = (10, 10, 10)


def made_up(face: NDArray[np.float32]) -> NDArray[np.uint8]:
    """A drawing whose eyes have lashes and black lines around them."""
    picture = painted(face, SIZE)
    for contour in (RIGHT_EYE, LEFT_EYE):
        cv2.polylines(picture, [face[list(contour), :2].round().astype(np.int32)], True, BLACK, 5)
        for vertex in contour:
            x, y = face[vertex, :2].round().astype(int).tolist()
            cv2.line(picture, (x, y), (x, y - 8), BLACK, 1)
    return picture


@pytest.mark.parametrize("side", [0, 1])
def test_an_even_face_has_even_sockets_whatever_its_eyes_are_like(side: int) -> None:
    skin = socket_skin(made_up(FACE), FACE, side)
    np.testing.assert_allclose(skin, np.broadcast_to(np.float32(SKIN), skin.shape), atol=2)


@pytest.mark.parametrize("side", [0, 1])
def test_light_from_aside_goes_on_across_the_eye(side: int) -> None:
    """By hand: skin that is lighter by 0.1 grey levels a pixel is so behind the eye, too."""
    plain = np.full((SIZE[1], SIZE[0], 3), SKIN, np.float32)
    ramp = 0.1 * (np.arange(SIZE[0]) - 250)[None, :, None]
    skin = np.clip(plain + ramp, 0, 255).round().astype(np.uint8)
    eyes = (made_up(FACE) != painted(FACE, SIZE)).any(axis=2)
    for contour in (RIGHT_EYE, LEFT_EYE):
        mask = np.zeros(eyes.shape, np.uint8)
        cv2.fillPoly(mask, [FACE[list(contour), :2].round().astype(np.int32)], 1)
        eyes |= mask > 0
    shown = np.where(eyes[..., None], made_up(FACE), skin)
    frame = socket_frame(FACE, side)
    places = frame.pixels(*socket_places(frame))
    wanted = np.float32(SKIN) + 0.1 * (places[..., :1] - 250)
    middle = np.s_[4:-4, 12:-12]
    np.testing.assert_allclose(socket_skin(shown, FACE, side)[middle], wanted[middle], atol=2.5)


@pytest.mark.parametrize("side", [0, 1])
def test_its_colours_are_of_the_range_of_the_skin_around(side: int) -> None:
    blotched = painted(FACE, SIZE).astype(np.float32)
    spots = np.random.default_rng(2).normal(0, 1, (*blotched.shape[:2], 1)).astype(np.float32)
    spots = np.asarray(cv2.GaussianBlur(spots, (0, 0), 9)).reshape(*blotched.shape[:2], 1)
    picture = np.clip(blotched + 8 * spots / spots.std(), 0, 255).astype(np.uint8)
    frame = socket_frame(FACE, side)
    along, down = socket_places(frame)
    places = np.rint(frame.pixels(along, down)).astype(int)
    around = picture[places[..., 1], places[..., 0]][beside_the_eye(frame, along, down)]
    skin = socket_skin(picture, FACE, side)
    assert (skin.min(axis=(0, 1)) > around.min(axis=0) - MAX_GRAIN_GREY_LEVELS / 3).all()
    assert (skin.max(axis=(0, 1)) < around.max(axis=0) + MAX_GRAIN_GREY_LEVELS / 3).all()


@pytest.mark.parametrize("side", [0, 1])
def test_it_has_the_grain_of_the_cheek_and_no_specks(side: int) -> None:
    grain = np.random.default_rng(0).normal(0, 4, (SIZE[1], SIZE[0], 1))
    picture = (made_up(FACE) + grain).round().clip(0, 255).astype(np.uint8)
    skin = socket_skin(picture, FACE, side)
    fine = skin - cv2.GaussianBlur(skin, (0, 0), 3)
    x, y = FACE[list(CHEEK_BELOW_LID_VERTICES[side]), :2].mean(axis=0).round().astype(int)
    cheek = picture[y - 15 : y + 15, x - 25 : x + 25].astype(np.float32)
    cheek -= cv2.GaussianBlur(cheek, (0, 0), 3)
    assert 0.5 * cheek.std() < fine.std() <= 1.05 * cheek.std()
    assert np.abs(fine).max() < 1.3 * np.abs(cheek).max()
    down, across = (np.abs(np.diff(skin.mean(axis=2), axis=axis)).mean() for axis in (0, 1))
    assert down == pytest.approx(across, rel=0.25), "not drawn out"


@pytest.mark.parametrize("side", [0, 1])
def test_a_lid_is_not_in_the_shadow_that_its_socket_is_in(side: int) -> None:
    """Of a picture in which all above the lower lid is in it."""
    picture = painted(FACE, SIZE)
    line = round(float(FACE[[145, 374], 1].mean()))
    picture[:line] = [round(0.35 * one) for one in SKIN]
    skin = socket_skin(picture, FACE, side)
    height, width = skin.shape[:2]
    middle = skin[height // 2, width // 3 : width // 2]
    np.testing.assert_allclose(middle, np.broadcast_to(np.float32(SKIN), middle.shape), atol=6)


@pytest.mark.parametrize("side", [0, 1])
def test_a_rim_of_glasses_above_an_eye_is_not_skin(side: int) -> None:
    """It is as light as skin, and of another colour."""
    picture = painted(FACE, SIZE)
    row = FACE[list(UPPER_LID_STRIPS[side][0]), :2].round().astype(np.int32)
    cv2.polylines(picture, [row], False, (110, 190, 230), 5)
    skin = socket_skin(picture, FACE, side)
    middle = skin[len(skin) // 2 :]
    np.testing.assert_allclose(middle, np.broadcast_to(np.float32(SKIN), middle.shape), atol=3)


@pytest.mark.parametrize("side", [0, 1])
def test_a_lid_is_no_darker_than_any_skin_around_it(side: int) -> None:
    """Of skin that is the darker the nearer it is to the eye."""
    frame = socket_frame(FACE, side)
    rows, columns = np.mgrid[: SIZE[1], : SIZE[0]]
    along, down = frame.of_pixels(columns, rows)
    lit = np.minimum(0.75 + 0.5 * ((along - 0.5) ** 2 + (2 * down) ** 2), 1)
    picture = (lit[..., None] * SKIN).astype(np.uint8)
    around = lit[beside_the_eye(frame, along, down)].min()
    skin = socket_skin(picture, FACE, side)
    assert (skin.min(axis=(0, 1)) > (around - 0.02) * np.array(SKIN)).all()


def test_lashes_are_beside_the_eye_s_edge() -> None:
    """By hand: a twentieth of an eye width from it they stand, and a fifth from it they do not."""
    frame = socket_frame(FACE, 0)
    middle = np.array([0.5])
    upper, lower = frame.rim(middle), np.interp(middle, *frame.lower.T)
    assert not beside_the_eye(frame, middle, upper - 0.05)[0] and not beside_the_eye(frame, middle, lower + 0.05)[0]
    assert beside_the_eye(frame, middle, upper - 0.2)[0] and beside_the_eye(frame, middle, lower + 0.2)[0]
    assert not beside_the_eye(frame, np.array([-0.05]), np.zeros(1))[0]


def test_eyes_at_a_picture_s_edge_have_sockets_too() -> None:
    face = FACE - np.float32([250, 170, 0])
    for side in range(2):
        assert np.isfinite(socket_skin(np.full((100, 120, 3), 200, np.uint8), face, side)).all()
        assert np.isfinite(socket_skin(np.zeros((100, 120, 3), np.uint8), face, side)).all()
