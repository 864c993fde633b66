"""Eyes as layers: at rest the picture stays, a gaze moves the iris by the asked distance, shut lids show no eye."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from made_face import BROWN, WHITE, painted, placed, shut
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import MIN_EYE_WIDTH_PIXELS, prepare_eyes, white_light
from engine.face_animation.eyes.eyes import draw_eye
from engine.face_animation.motion_transfer.lids_and_lips import LID_EDGE_VERTEX_PAIRS
from engine.perception.face.landmarks import LEFT_EYE, LEFT_IRIS, RIGHT_EYE, RIGHT_IRIS

SIZE = (360, 320)
REST = np.zeros(2)
CONTOURS, IRISES = (RIGHT_EYE, LEFT_EYE), (RIGHT_IRIS, LEFT_IRIS)


@pytest.fixture(scope="module")
def mesh() -> NDArray[np.float32]:
    """Wide open eyes, so that the whole iris can be measured."""
    wide = shut(placed(120, (180, 140)), 1.6)
    lower = np.array(LID_EDGE_VERTEX_PAIRS)[:, 1]
    wide[lower, 1] += 9 * np.repeat([[0.4, 0.8, 1, 1, 1, 0.8, 0.4]], 2, axis=0).ravel()
    return wide


@pytest.fixture(scope="module")
def picture(mesh: NDArray) -> NDArray[np.uint8]:
    return painted(mesh, SIZE)


def width(mesh: NDArray, side: int) -> float:
    contour = CONTOURS[side]
    return float(np.linalg.norm(mesh[contour[0], :2] - mesh[contour[8], :2]))


def iris_centre(picture: NDArray, mesh: NDArray, side: int) -> NDArray[np.float64]:
    """Centre of gravity of the iris' brown in an eye's opening, pixels."""
    opening = np.zeros(picture.shape[:2], np.uint8)
    cv2.fillPoly(opening, [mesh[list(CONTOURS[side]), :2].round().astype(np.int32)], 1)
    brown = np.clip(1 - np.linalg.norm(picture.astype(float) - BROWN, axis=2) / 150, 0, 1) * opening
    ys, xs = np.mgrid[: picture.shape[0], : picture.shape[1]]
    return np.array([(xs * brown).sum(), (ys * brown).sum()]) / brown.sum()


def drawn(picture: NDArray, mesh: NDArray, at: NDArray, look: NDArray = REST) -> NDArray[np.uint8]:
    """The picture with both eyes drawn anew, with the face at `at`."""
    out = picture.copy()
    for side, eye in enumerate(prepare_eyes(picture, mesh)):
        assert eye is not None
        draw_eye(out, eye, at, side, look)
    return out


def test_at_rest_the_picture_stays(picture: NDArray, mesh: NDArray) -> None:
    change = np.abs(drawn(picture, mesh, mesh).astype(int) - picture)
    opening = np.zeros(picture.shape[:2], np.uint8)
    for contour in CONTOURS:
        cv2.fillPoly(opening, [mesh[list(contour), :2].round().astype(np.int32)], 1)
    assert change[opening > 0].mean() < 3
    assert (change.max(axis=2)[cv2.erode(opening, np.ones((5, 5))) > 0] < 12).mean() > 0.93  # but for the iris' rim


def test_nothing_outside_the_lids_is_touched(picture: NDArray, mesh: NDArray) -> None:
    out = drawn(picture, mesh, mesh, np.array([0.15, 0.05]))
    around = np.zeros(picture.shape[:2], np.uint8)
    for contour in CONTOURS:
        cv2.fillPoly(around, [mesh[list(contour), :2].round().astype(np.int32)], 1)
    around = cv2.dilate(around, np.ones((5, 5)))
    np.testing.assert_array_equal(out[around == 0], picture[around == 0])


@pytest.mark.parametrize("look", [(0.1, 0.0), (-0.12, 0.0), (0.0, 0.06), (0.08, -0.05)])
@pytest.mark.parametrize("side", [0, 1])
def test_a_gaze_moves_the_iris_by_the_asked_distance(picture, mesh, look: tuple[float, float], side: int) -> None:
    """Along and across the line from the eye's outer to its inner corner, in eye widths."""
    eye = prepare_eyes(picture, mesh)[side]
    assert eye is not None
    out = picture.copy()
    draw_eye(out, eye, mesh, side, np.array(look))
    along = mesh[CONTOURS[side][8], :2] - mesh[CONTOURS[side][0], :2]
    across = np.array([-along[1], along[0]])
    asked = look[0] * along + look[1] * across
    moved = iris_centre(out, mesh, side) - iris_centre(picture, mesh, side)
    assert np.linalg.norm(moved - asked) < max(0.15 * np.linalg.norm(asked), 0.6)


def test_closing_lids_move_over_the_eyeball(picture: NDArray, mesh: NDArray) -> None:
    """The iris does not shrink or sink with the lid: what is still open shows what was there."""
    half = shut(mesh, 0.55)
    out = drawn(picture, mesh, half)
    for side in (0, 1):
        opening = np.zeros(picture.shape[:2], np.uint8)
        cv2.fillPoly(opening, [half[list(CONTOURS[side]), :2].round().astype(np.int32)], 1)
        still = cv2.erode(opening, np.ones((3, 3))) > 0
        assert np.abs(out[still].astype(int) - picture[still]).mean() < 6


def test_what_lids_hide_of_the_iris_is_completed(mesh: NDArray) -> None:
    """Eyes narrow in the picture, wide in the frame: the iris is a disk, brown above and below."""
    narrow = shut(mesh, 0.45)
    wide = drawn(painted(narrow, SIZE), narrow, mesh)
    for side in (0, 1):
        centre = mesh[IRISES[side][0], :2]
        radius = float(np.linalg.norm(mesh[list(IRISES[side][1:]), :2] - centre, axis=1).mean())
        opening = mesh[list(CONTOURS[side]), :2]
        for dy in (-0.6, 0.6):
            x, y = round(float(centre[0])), round(float(centre[1] + dy * radius))
            if cv2.pointPolygonTest(opening, (float(x), float(y)), True) > 2:
                assert np.linalg.norm(wide[y, x].astype(float) - BROWN) < 40


def test_a_white_between_dark_lashes_is_white_all_over(mesh: NDArray) -> None:
    """What is lash or shadow along the lids does not become the white behind them."""
    rgb = painted(mesh, SIZE)
    for contour in CONTOURS:
        cv2.polylines(rgb, [mesh[list(contour), :2].round().astype(np.int32)], True, (40, 25, 20), 5)
    narrow = shut(mesh, 0.7)
    wide = drawn(rgb, narrow, mesh, np.array([0.1, 0.0]))
    for side in (0, 1):
        opening = np.zeros(rgb.shape[:2], np.uint8)
        cv2.fillPoly(opening, [mesh[list(CONTOURS[side]), :2].round().astype(np.int32)], 1)
        centre = mesh[IRISES[side][0], :2] + 0.1 * (mesh[CONTOURS[side][8], :2] - mesh[CONTOURS[side][0], :2])
        radius = float(np.linalg.norm(mesh[list(IRISES[side][1:]), :2] - mesh[IRISES[side][0], :2], axis=1).mean())
        cv2.circle(opening, centre.round().astype(int).tolist(), round(1.4 * radius), 0, -1)
        white = wide[cv2.erode(opening, np.ones((3, 3))) > 0].astype(float)
        assert len(white) > 30
        assert (white.min(axis=1) > 0.5 * np.array(WHITE).mean()).mean() > 0.95
        assert np.ptp(white / white.mean(axis=1, keepdims=True), axis=1).max() < 0.35, "and of no colour of its own"


def test_a_catch_light_stays_nearly_where_it_was(mesh: NDArray) -> None:
    rgb = painted(mesh, SIZE)
    centre = mesh[RIGHT_IRIS[0], :2]
    light = (centre + np.array([-2, -3])).round().astype(int)
    cv2.circle(rgb, light.tolist(), 2, (255, 255, 255), -1)
    eye = prepare_eyes(rgb, mesh)[0]
    assert eye is not None
    look = np.array([0.1, 0.0])
    out = rgb.copy()
    draw_eye(out, eye, mesh, 0, look)
    iris = np.zeros(rgb.shape[:2], np.uint8)
    moved = centre + look[0] * (mesh[133, :2] - mesh[33, :2])
    cv2.circle(iris, moved.round().astype(int).tolist(), 8, 1, -1)
    bright = (out.min(axis=2) > 180) & (iris > 0)
    found = np.argwhere(bright)[:, ::-1].mean(axis=0)
    gone, iris_way = np.linalg.norm(found - light), np.linalg.norm(moved - centre)
    assert gone < 0.6 * iris_way


def test_small_and_shut_eyes_of_a_picture_have_no_layer(mesh: NDArray) -> None:
    tiny = placed(MIN_EYE_WIDTH_PIXELS, (180, 140))
    assert prepare_eyes(painted(tiny, SIZE), tiny) == (None, None)
    closed = shut(mesh, 0.05)
    assert prepare_eyes(painted(closed, SIZE), closed) == (None, None)


@pytest.mark.parametrize("place", [(-40.0, 140.0), (400.0, 140.0), (180.0, -70.0), (180.0, 400.0)])
def test_eyes_at_or_beyond_the_border_do_no_harm(picture: NDArray, mesh: NDArray, place: tuple[float, float]) -> None:
    at = mesh[:, :2] - (180, 140) + place
    drawn(picture, mesh, at)
    prepare_eyes(picture, at)


def test_a_real_portrait_at_rest_stays(media: Callable[[str], Path]) -> None:
    from engine.media.image import read_image
    from engine.perception.face.faces import find_faces

    picture = np.ascontiguousarray(read_image(media("portraits/photo_woman_outdoor.jpg")).rgb)
    mesh = find_faces(picture)[0]
    change = np.abs(drawn(picture, mesh, mesh).astype(int) - picture)
    for contour in CONTOURS:
        opening = np.zeros(picture.shape[:2], np.uint8)
        cv2.fillPoly(opening, [mesh[list(contour), :2].round().astype(np.int32)], 1)
        assert change[opening > 0].mean() < 4


def test_an_eyeball_is_round_and_passes_softly_into_the_lids(mesh: NDArray) -> None:
    """Its white is darker towards the corners, where the picture's is shaded at all, and no step stands at the lower lid."""
    opening = mesh[list(CONTOURS[0]), :2].astype(np.float32)
    low = opening.min(axis=0) - 2
    shape = tuple(int(n) for n in np.ceil(np.ptp(opening, axis=0))[::-1] + 5)
    light = white_light(0.3, opening - low, shape)
    middle = shape[0] * 3 // 4
    assert light[middle, 3] < 0.8 * light[middle, shape[1] // 2]
    assert (white_light(0.0, opening - low, shape) == 1).all(), "drawn eyes are flat"
    rgb = painted(mesh, SIZE)
    wide = drawn(rgb, mesh, mesh, np.array([0.2, 0.0])).astype(int)
    x, y = mesh[145, :2].round().astype(int)
    steps = np.abs(np.diff(wide[y - 4 : y + 5, x - 8].mean(axis=-1)))
    assert steps.max() < 0.8 * np.ptp(wide[y - 4 : y + 5, x - 8].mean(axis=-1))
