"""Upper lids that close take the colour and the grain of the skin above them."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from made_face import SKIN, painted, placed, shut
from numpy.typing import NDArray

from engine.face_animation.eyes.eyeball import prepare_eyes
from engine.face_animation.eyes.eyes import lid_closing_share
from engine.face_animation.eyes.lid_colours import (
    BELOW_BROW_VERTICES,
    MIN_CHEEK_SHARE,
    SOCKET_SHADE_SHARE,
    UPPER_LID_STRIPS,
)
from engine.face_animation.eyes.lid_skin import (
    CREASE_PLACE_SHARE,
    EDGE_SHADE_SHARE,
    MAX_GRAIN_GREY_LEVELS,
    draw_lid,
    lid_skins,
)

FACE = placed(160, (250, 200))
SIZE = (500, 600)
BLACK = (10, 10, 10)


def made_up(face: NDArray[np.float32]) -> NDArray[np.uint8]:
    """A drawing whose lids are black from the skin above to the lashes."""
    picture = painted(face, SIZE)
    for above, edge in UPPER_LID_STRIPS:
        inner = 0.25 * face[list(above), :2] + 0.75 * face[list(edge), :2]
        band = np.concatenate([inner, face[list(edge)[::-1], :2]])
        cv2.fillPoly(picture, [band.round().astype(np.int32)], BLACK)
    return picture


def lid(face: NDArray[np.float32], side: int, way: float = 0.75) -> tuple[int, int]:
    """A pixel of the lid's middle, so far on the way from the skin above to the edge."""
    above, edge = (face[row[3], :2] for row in UPPER_LID_STRIPS[side])
    x, y = (1 - way) * above + way * edge
    return round(float(x)), round(float(y))


@pytest.mark.parametrize("side", [0, 1])
def test_a_lid_that_closes_is_skin_and_no_drawn_out_lashes(side: int) -> None:
    skin = lid_skins(made_up(FACE), FACE)[side]
    np.testing.assert_allclose(skin[0], np.tile(SKIN, (skin.shape[1], 1)), atol=6)
    np.testing.assert_allclose(skin[-1], (1 - EDGE_SHADE_SHARE) * skin[0], atol=6)
    closed = shut(FACE)
    frame = made_up(closed)
    x, y = lid(closed, side)
    assert frame[y, x].max() < 30
    before = frame.copy()
    draw_lid(frame, skin, closed[:, :2], side, 0.0)
    np.testing.assert_array_equal(frame, before)
    draw_lid(frame, skin, closed[:, :2], side, 1.0)
    shares = frame[y, x] / np.array(SKIN)
    assert shares.min() > 0.85 and shares.max() < 1.08 and np.ptp(shares) < 0.04, "skin, in its own hue"
    other = lid(closed, 1 - side)
    np.testing.assert_array_equal(frame[other[1], other[0]], before[other[1], other[0]])
    changed = (frame != before).any(axis=2)
    strip = closed[[v for row in UPPER_LID_STRIPS[side] for v in row], :2]
    left, top = strip.min(axis=0) - 25
    right, bottom = strip.max(axis=0) + 25
    ys, xs = np.nonzero(changed)
    assert xs.min() >= left and xs.max() <= right and ys.min() >= top and ys.max() <= bottom


def test_a_lid_lies_over_a_ball_below_its_crease() -> None:
    skin = lid_skins(made_up(FACE), FACE)[0].mean(axis=2)
    middle = skin[:, skin.shape[1] // 2]
    crease = round(CREASE_PLACE_SHARE * (len(middle) - 1))
    ball = round((1 + CREASE_PLACE_SHARE) / 2 * (len(middle) - 1))
    assert middle[crease] < 0.93 * middle[ball]
    assert middle[-1] < 0.95 * middle[ball], "lashes shade its edge"
    corner = skin[:, 0]
    assert np.abs(np.diff(corner)).max() < 6, "neither crease nor ball at the corners"


@pytest.mark.parametrize("side", [0, 1])
def test_its_grain_is_that_of_the_skin_above_without_lashes(side: int) -> None:
    plain = painted(FACE, SIZE)
    grain = np.random.default_rng(0).normal(0, 4, (*plain.shape[:2], 1))
    picture = (plain + grain).round().clip(0, 255).astype(np.uint8)
    x, y = (
        FACE[[UPPER_LID_STRIPS[side][0][3], BELOW_BROW_VERTICES[side][3]], :2].mean(axis=0).round().astype(int).tolist()
    )
    cv2.line(picture, (x, y - 8), (x, y + 8), BLACK, 1)
    apart = lid_skins(picture, FACE)[side] - lid_skins(plain, FACE)[side]
    assert 2 < apart.std() < 5 and np.abs(apart).max() < MAX_GRAIN_GREY_LEVELS + 8


@pytest.mark.parametrize("side", [0, 1])
def test_a_lid_is_not_as_dark_as_the_socket_s_shadow(side: int) -> None:
    picture = painted(FACE, SIZE)
    above = [list(UPPER_LID_STRIPS[side][0]), list(BELOW_BROW_VERTICES[side])]
    band = np.concatenate([1.4 * FACE[above[1], :2] - 0.4 * FACE[above[0], :2], FACE[above[0][::-1], :2]])
    shadow = np.array(SKIN) * 0.4
    cv2.fillPoly(picture, [band.round().astype(np.int32)], shadow.round().astype(int).tolist())
    skin = lid_skins(picture, FACE)[side]
    middle = skin[0, skin.shape[1] // 2].mean() / np.mean(SKIN)
    assert middle == pytest.approx(MIN_CHEEK_SHARE - SOCKET_SHADE_SHARE * (MIN_CHEEK_SHARE - 0.4), abs=0.05)
    assert skin[0, 0].mean() < 0.5 * np.mean(SKIN), "nothing changes at the corners"


def test_its_grain_is_not_drawn_out() -> None:
    rng = np.random.default_rng(1)
    plain = painted(FACE, SIZE)
    picture = (plain + rng.normal(0, 4, (SIZE[1], SIZE[0], 1))).round().clip(0, 255).astype(np.uint8)
    skin = (lid_skins(picture, FACE)[0] - lid_skins(plain, FACE)[0]).mean(axis=2)
    down = np.abs(np.diff(skin, axis=0)).mean()
    across = np.abs(np.diff(skin, axis=1)).mean()
    assert down == pytest.approx(across, rel=0.25)
    edge, lower = FACE[UPPER_LID_STRIPS[0][1][3], :2], FACE[145, :2]
    assert len(skin) > np.linalg.norm(lower - edge), "as tall as the eye that it covers"


def test_it_begins_where_the_lid_begins_to_close() -> None:
    eyes = prepare_eyes(painted(FACE, SIZE), FACE)
    for side, eye in enumerate(eyes):
        assert eye is not None
        shares = [lid_closing_share(eye, shut(FACE, share)[:, :2], side) for share in (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)]
        assert shares[0] == 0 and shares[-2:] == [1, 1]
        assert (np.diff(shares) >= 0).all() and 0 < shares[2] < 1


def test_a_face_at_the_picture_s_edge_is_drawn_as_far_as_it_goes() -> None:
    face = FACE - np.float32([250, 170, 0])
    frame = np.full((100, 120, 3), 200, np.uint8)
    for side in (0, 1):
        draw_lid(frame, np.full((4, 9, 3), 50, np.float32), face[:, :2], side, 1.0)
    assert frame.min() < 100


@pytest.mark.parametrize("side", [0, 1])
def test_no_white_is_left_beside_the_line_where_lids_meet(side: int) -> None:
    """Of a picture whose eye is larger than the mesh's, above, below and beyond the corners."""
    closed = shut(FACE, 0.02)
    frame = np.full((SIZE[1], SIZE[0], 3), SKIN, np.uint8)
    outer, inner = ((33, 133), (263, 362))[side]
    line = closed[[outer, *UPPER_LID_STRIPS[side][1], inner], :2]
    cv2.polylines(frame, [line.round().astype(np.int32)], False, (255, 255, 255), 3)
    draw_lid(frame, lid_skins(painted(FACE, SIZE), FACE)[side], closed[:, :2], side, 1.0)
    assert frame.min(axis=2).max() <= max(SKIN), "no lighter than skin"


@pytest.mark.parametrize("side", [0, 1])
def test_a_highlight_above_a_lid_is_not_drawn_over_it(side: int) -> None:
    """The lid is as light as the cheek, and of its hue."""
    picture = painted(FACE, SIZE)
    rows = [FACE[list(row), :2] for row in (UPPER_LID_STRIPS[side][0], BELOW_BROW_VERTICES[side])]
    cv2.fillPoly(picture, [np.concatenate([rows[0], rows[1][::-1]]).round().astype(np.int32)], (250, 250, 250))
    skin = lid_skins(picture, FACE)[side]
    np.testing.assert_allclose(skin[0].mean(axis=0), SKIN, atol=8)
