"""Heads from behind and from the side: hair down to the nape, no face, and nothing of the room behind."""

from __future__ import annotations

from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from engine.character.figure.face_region import face_turn
from engine.character.surface.front_and_back import ClosedMesh, Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface
from engine.character.texture.head_area import measure_head
from engine.character.texture.head_texture import back_of_the_head, find_hair, nape_height
from engine.character.texture.round_sides import with_round_sides
from engine.geometry.mesh.welding import is_closed

SKIN, BROWN, WHITE, BLACK, PINK = (225, 175, 150), (75, 48, 32), (205, 203, 200), (12, 12, 14), (220, 60, 150)
FACE = np.float32([100, 110, 40, 50, 0])
SCALE = 2.0


def head(hair: tuple[int, ...], wall: tuple[int, ...], long: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A head with hair around its face, a neck, and a rim in which hair is mixed with the wall behind: the picture, the
    person's mask, and where there is hair."""
    shape = 260, 200
    mask, face, inner = (np.zeros(shape, np.uint8) for _ in range(3))
    cv2.ellipse(mask, (100, 95), (66, 78), 0, 0, 360, (1,), -1)
    mask[150:230, 34 if long else 70 : 166 if long else 130] = 1
    cv2.ellipse(face, (100, 110), (40, 50), 0, 0, 360, (1,), -1)
    face[120:, 70:130] = 1
    mask = np.maximum(mask, face)
    inner = cv2.erode(mask, np.ones((3, 3), np.uint8), iterations=3)
    rgb = np.empty((*shape, 3), np.float32)
    rgb[:] = wall
    rgb[mask > 0] = np.float32(hair) * 0.5 + np.float32(wall) * 0.5
    rgb[inner > 0] = hair
    rgb[face > 0] = SKIN
    for x in (82, 118):
        cv2.circle(rgb, (x, 100), 6, (30, 30, 30), -1)
    rgb += np.random.default_rng(2).normal(size=rgb.shape) * 4
    there = (inner > 0) & (face == 0) & (np.arange(260)[:, None] < (260 if long else 150))
    return np.clip(rgb, 0, 255).astype(np.uint8), mask > 0, there


def behind(rgb: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    back, front = back_of_the_head(rgb, rgb, mask, mask, mask, FACE, 0.0, SCALE)
    return back.astype(float), front.astype(float)


def away(colours: np.ndarray, colour: tuple[int, ...]) -> np.ndarray:
    return np.linalg.norm(colours - np.array(colour), axis=-1)


def test_above_the_nape_the_back_is_of_the_hair_s_colour_and_below_it_is_the_neck() -> None:
    for hair, wall in ((BROWN, (150, 160, 170)), (WHITE, BLACK), (BLACK, PINK)):
        rgb, mask, there = head(hair, wall)
        back, _ = behind(rgb, mask)
        crown = mask & (np.arange(260)[:, None] < 125)
        off = away(back[crown], tuple(np.median(rgb[there], axis=0)))
        assert np.median(off) < 15 and np.percentile(off, 99) < 40, (hair, wall)
        assert np.percentile(away(back[crown], SKIN), 1) > 0.6 * np.linalg.norm(np.subtract(SKIN, hair))
        assert np.median(away(back[185:215, 80:120], SKIN)) < 20
        np.testing.assert_array_equal(back[~mask], rgb[~mask])


def test_a_beard_and_dark_spectacles_keep_no_hair_from_being_hair() -> None:
    rgb, mask, _ = head(BROWN, (150, 160, 170))
    where = measure_head(mask, mask, FACE, SCALE)
    bare, _ = find_hair(rgb, rgb, where)
    chin = np.zeros(mask.shape, np.uint8)
    cv2.ellipse(chin, (100, 138), (28, 14), 0, 0, 360, (1,), -1)
    rgb[chin > 0] = rgb[95:104, 70:130] = BROWN
    bearded, _ = find_hair(rgb, rgb, where)
    np.testing.assert_array_equal(bearded, bare)


def test_long_hair_hides_the_neck() -> None:
    rgb, mask, _ = head(BROWN, (150, 160, 170), long=True)
    back, _ = behind(rgb, mask)
    assert np.median(away(back[150:215, 60:140], BROWN)) < 15


def test_what_is_behind_the_person_is_not_carried_over_the_sides_of_the_head() -> None:
    rgb, mask, _ = head(WHITE, BLACK)
    _, front = behind(rgb, mask)
    depth = cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, 5)
    rim = mask & (depth <= 2) & (np.arange(260)[:, None] < 80)
    assert np.median(away(rgb[rim].astype(float), WHITE)) > 100
    assert np.median(away(front[rim], WHITE)) < 15
    inside = mask & (depth > 10)
    np.testing.assert_array_equal(front[inside], rgb[inside])


def test_a_head_all_of_one_colour_stays_as_it_is() -> None:
    mask = np.zeros((260, 200), np.bool_)
    mask[20:230, 40:160] = True
    rgb = np.full((260, 200, 3), SKIN, np.uint8)
    back, _ = behind(rgb, mask)
    assert np.abs(back - SKIN).max() <= 2


def ball(radius: int = 26) -> tuple[ClosedMesh, np.ndarray]:
    """A round head."""
    size = 2 * radius + 28
    y, x = np.indices((size, size)) - (size - 1) / 2
    deep = radius**2 - x**2 - y**2
    mask = deep > 0
    deep = np.sqrt(np.maximum(deep, 0))
    weights = np.ones((size, size, 1), np.float32)
    sides = [Surface(np.where(mask, sign * deep, np.nan).astype(np.float32), weights) for sign in (1, -1)]
    return stitch_front_and_back([Layer(mask, sides[0], sides[1])], mask.astype(np.float32)), mask


def test_the_back_s_colours_begin_within_the_outline_and_lie_at_the_pace_of_the_surface() -> None:
    before, mask = ball()
    mesh = with_round_sides(before, mask, np.zeros_like(mask), 0)
    _, points = np.unique(mesh.vertices, axis=0, return_inverse=True)
    assert is_closed(points.ravel()[mesh.triangles])
    assert len(mesh.triangles) == len(before.triangles)
    of_front, of_back = mesh.front[mesh.triangles].all(1), ~mesh.front[mesh.triangles].any(1)
    assert (of_front | of_back).all(), "no triangle lies on two pictures"
    assert np.isnan(mesh.places[mesh.front]).all(), "the front shows what it shows"
    assert not mesh.front[mesh.rim].any()
    laid = np.where(np.isnan(mesh.places), mesh.vertices[:, :2], mesh.places)
    level = mesh.triangles[of_back][:, [0, 1]]
    row = np.abs(mesh.vertices[level, 1] - 39.5).max(1) < 6
    edges = level[row & (np.ptp(mesh.vertices[level, 1], axis=1) < 0.1)]
    space = np.linalg.norm(np.diff(mesh.vertices[edges], axis=1)[:, 0], axis=1)
    shown = np.linalg.norm(np.diff(laid[edges], axis=1)[:, 0], axis=1)
    flat = np.linalg.norm(np.diff(mesh.vertices[edges, :2], axis=1)[:, 0], axis=1)
    assert np.percentile(space / np.maximum(flat, 1e-6), 98) > 4, "stretched, were they not laid so"
    assert np.percentile(space / np.maximum(shown, 1e-6), 95) < 2.5
    middle = np.linalg.norm(mesh.vertices[:, :2] - 39.5, axis=1) < 2
    assert np.linalg.norm(laid[middle] - mesh.vertices[middle, :2], axis=1).max() < 2.5


def test_what_is_upright_keeps_its_height() -> None:
    before, mask = ball()
    nothing = np.zeros_like(mask)
    mesh = with_round_sides(before, mask, nothing, 0, mask)
    laid = np.isfinite(mesh.places[:, 0])
    inner = laid & (np.abs(mesh.vertices[:, :2] - 39.5).max(1) < 12)
    np.testing.assert_allclose(mesh.places[inner, 1], mesh.vertices[inner, 1], atol=1e-3)
    free = with_round_sides(before, mask, nothing, 0)
    assert np.abs(free.places[inner, 1] - free.vertices[inner, 1]).max() > 1
    np.testing.assert_allclose(mesh.places[inner, 0], free.places[inner, 0])


def test_a_head_that_fills_the_picture_has_round_sides_too() -> None:
    mesh, mask = ball(108)
    assert len(with_round_sides(mesh, mask, np.zeros_like(mask), 0).vertices) > len(mesh.vertices) > 70_000


def test_no_face_stays_behind_on_a_head_that_the_picture_cuts_off_at_the_brows() -> None:
    rgb, mask, _ = head(WHITE, PINK)
    cut = 88
    back, _ = back_of_the_head(
        rgb[cut:], rgb[cut:], mask[cut:], mask[cut:], mask[cut:], FACE - [0, cut, 0, 0, 0], 0.0, SCALE
    )
    eyes = back[8:17, 76:125].astype(float)
    assert away(eyes, (30, 30, 30)).min() > 100 and np.median(away(eyes, SKIN)) > 40


def test_a_cheek_at_the_outline_goes_on_behind_it_and_hair_at_the_outline_does() -> None:
    rgb, mask, _ = head(BROWN, (150, 160, 170))
    turned = mask & (np.arange(200) > 68)  # the face's own edge is the outline now, on one side
    back, _ = back_of_the_head(rgb, rgb, turned, turned, turned, FACE, -0.5, SCALE)
    rows = slice(105, 130)
    assert np.median(away(back[rows, 71:76].astype(float), SKIN)) < 45
    assert np.median(away(back[rows, 100:140].astype(float), BROWN)) < 40
    assert np.median(away(back[60:80, 72:130].astype(float), BROWN)) < 40


@pytest.mark.parametrize("to", [-0.1, 0.0, 0.5])
def test_what_is_at_the_outline_of_a_face_that_does_not_turn_away_there_is_an_ear(to: float) -> None:
    rgb, mask, _ = head(BROWN, (150, 160, 170))
    seen = mask & (np.arange(200) > 68)
    back, _ = back_of_the_head(rgb, rgb, seen, seen, seen, FACE, to, SCALE)
    assert np.median(away(back[105:130, 71:76].astype(float), BROWN)) < 40


def test_a_far_cheek_in_the_shade_is_one_and_goes_on_as_skin() -> None:
    rgb, mask, _ = head(BROWN, (150, 160, 170))
    turned = mask & (np.arange(200) > 68)
    rgb[100:125, 60:74] = np.array(SKIN) * 0.45  # an eye's corner, a shadow
    back, _ = back_of_the_head(rgb, rgb, turned, turned, turned, FACE, -0.5, SCALE)
    assert np.median(away(back[100:125, 72:76].astype(float), SKIN)) < 45


@pytest.mark.parametrize(("nose", "turn"), [(150, 0.0), (180, 0.6), (110, -0.8), (300, 1.0)])
def test_a_face_turns_to_where_its_nose_is(nose: float, turn: float) -> None:
    face = np.full((478, 3), 150, np.float32)
    face[[234, 1, 454], 0] = 100, nose, 200
    assert face_turn(SimpleNamespace(face=face)) == pytest.approx(turn)  # type: ignore[arg-type]
    assert face_turn(SimpleNamespace(face=None)) == 0  # type: ignore[arg-type]


def test_fair_hair_of_which_little_is_told_from_skin_is_long_where_it_hangs_beside_the_face() -> None:
    _, mask, there = head(BROWN, (150, 160, 170), long=True)
    oval = measure_head(mask, mask, np.array(FACE, float), SCALE)
    assert oval.width_at(-0.8) == pytest.approx(132 / 80, abs=0.1)
    low = there & (oval.up < -0.6)
    few = there & ~low
    rows = np.cumsum(low, axis=0) * low
    few |= low & (rows <= 3)
    share = (few & (oval.up < -0.6)).sum() / mask.sum()
    assert 0.0055 < share < 0.011
    assert nape_height(few, oval) < -1
    _, narrow_mask, _ = head(BROWN, (150, 160, 170))
    short = measure_head(narrow_mask, narrow_mask, np.array(FACE, float), SCALE)
    assert nape_height(few & narrow_mask, short) > -1
