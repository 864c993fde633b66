"""Bare hands and arms: of the mean body, whose colours are known everywhere."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.fit.template_fit import load_human
from engine.character.parts.labels import ARM_LABELS
from engine.character.shell.colours.bare_rows import BareRows, bare_rows, skin_colour
from engine.character.shell.colours.bare_skin import (
    BareHand,
    BareSkin,
    bare_skin,
    hands_of_the_template,
    metres_past_wrists,
)
from engine.character.shell.colours.painted_hands import with_painted_hands
from engine.character.shell.colours.round import COLUMN_RADIANS, coloured_round
from engine.character.shell.colours.texels import SHELL_TEXTURE_SIZE_TEXELS, texels
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS, unrolled_parts
from engine.character.shell.template_mesh import template_mesh
from engine.imaging.histogram_matching import to_lab
from engine.render.rasterisation.attributes import interpolate
from engine.render.rasterisation.rasteriser import rasterise

SKIN, SHADE, COAT, LEATHER = (205, 155, 130), (120, 80, 58), (40, 60, 110), (50, 50, 55)
PIXELS_PER_METRE = 300.0
ALL, NONE, ROWS = slice(None), np.zeros(0, np.uint8), 120
FACE = np.tile(np.array(SKIN, np.uint8), (100, 1))
TONE = to_lab(np.array(SKIN))[0]


def dressed(colour: Callable[[NDArray[np.floating]], NDArray[np.integer]], face: NDArray[np.uint8] = FACE) -> tuple[
    BareSkin | None, NDArray[np.floating]
]:  # fmt: skip
    """The skin of who is seen from before, the left arm in `colour` by metres past its wrist and all else bare; and these (h, w), NaN elsewhere."""
    mesh = template_mesh()
    rest = load_human().space.mean[mesh.ids].astype(np.float64)
    size = np.ceil(np.ptp(rest, 0)[[1, 0]] * PIXELS_PER_METRE).astype(int) + 20
    middle = (rest.max(0) + rest.min(0)) / 2
    pictured = (rest - middle) * [PIXELS_PER_METRE, -PIXELS_PER_METRE, PIXELS_PER_METRE] + [size[1] / 2, size[0] / 2, 0]
    raster = rasterise(pictured * [1, 1, -1], mesh.triangles, (int(size[0]), int(size[1])))
    mask = raster.triangle >= 0
    part = mesh.parts.argmax(1)[mesh.triangles[raster.triangle]][..., 0]
    labels = np.where(mask, part, -1).astype(np.int8)
    past = interpolate(np.nan_to_num(metres_past_wrists()[0])[:, None], mesh.triangles, raster)[..., 0]
    past = np.where(labels == ARM_LABELS[0], past, np.nan)
    rgb = np.broadcast_to(np.array(SKIN, np.uint8), (*mask.shape, 3)).copy()
    own = np.isfinite(past)
    rgb[own] = colour(past[own])
    return bare_skin(rgb, face, labels, pictured, mesh.triangles), past


def stepped(at: float, before: tuple[int, int, int], after: tuple[int, int, int]) -> Callable[..., NDArray]:
    return lambda past: np.where((past < at)[:, None], before, after)


def test_what_is_before_the_fingers_of_a_bare_hand_is_not_its() -> None:
    found, past = dressed(stepped(0.08, SKIN, COAT))
    assert found is not None and found.hands[0] is not None and found.hands[1] is not None
    assert found.strange[past > 0.1].mean() > 0.9
    assert not found.strange[past < 0.07].any()
    np.testing.assert_allclose(found.hands[0].tone, TONE, atol=1)


def test_neither_a_sleeve_nor_its_cuff_is_strange_and_skin_in_the_shade_is_skin() -> None:
    found, _ = dressed(stepped(0.02, COAT, SHADE))
    assert found is not None and found.hands[0] is not None
    assert not found.strange.any()
    assert found.hands[0].cuff == pytest.approx(0.02, abs=0.012)
    assert found.hands[1] is not None
    np.testing.assert_array_equal(found.hands[0].tone, found.hands[1].tone)  # one light falls on both


def test_hands_in_gloves_are_left_and_so_is_who_has_no_skin() -> None:
    found, _ = dressed(stepped(-0.05, SKIN, LEATHER))
    assert found is not None and found.hands[0] is None and found.hands[1] is not None
    assert not found.strange.any()
    assert dressed(stepped(0, SKIN, SKIN), np.tile(np.array((90, 120, 200), np.uint8), (100, 1)))[0] is None


def test_hands_are_painted_in_their_tones_beyond_their_sleeves() -> None:
    ground = np.full((SHELL_TEXTURE_SIZE_TEXELS, SHELL_TEXTURE_SIZE_TEXELS, 3), COAT, np.float32)
    painted = with_painted_hands(ground, (BareHand(TONE, 0.03), None))
    mesh, raster = template_mesh(), texels()
    past = interpolate(np.nan_to_num(metres_past_wrists(), nan=-1).T, mesh.triangles, raster)
    there = raster.triangle >= 0
    changed = (painted != ground).any(-1) & there
    assert not changed[past[..., 0] < 0.025].any()
    assert changed[past[..., 0] > 0.05].all()
    ends = (past[..., 0] > 0.03) & (past[..., 0] < 0.04)
    cuff, bare = (with_painted_hands(ground, (BareHand(TONE, at), None))[ends] for at in (0.026, 0.0))
    away = [float(np.abs(hand - ground[ends]).mean()) for hand in (cuff, bare)]
    assert away[1] < 0.7 * away[0], "a hand begins at once at a sleeve's end, and softly where the arm is bare"
    middle = np.median(to_lab(painted[past[..., 0] > 0.05]), 0)
    assert np.linalg.norm(middle - TONE) < 4
    assert to_lab(painted[past[..., 0] > 0.05])[:, 0].std() > 1, "nails, knuckles and creases"


def test_rows_of_skin_are_bare_in_light_and_shade_and_those_of_a_sleeve_are_not() -> None:
    colours = np.empty((ROWS, UNROLLED_COLUMNS, 3), np.float32)
    colours[:40], colours[40:80], colours[80:] = COAT, SHADE, SKIN
    source = np.zeros((ROWS, UNROLLED_COLUMNS), np.bool_)
    source[10:100, 150:250] = True
    rows, cells = bare_rows(colours, source, TONE, 110)
    assert rows[45:].all() and not rows[:35].any()
    np.testing.assert_allclose(skin_colour(cells, TONE), SHADE, atol=1)  # most of what is seen
    np.testing.assert_allclose(skin_colour(np.zeros((0, 3)), TONE), SKIN, atol=1)


def test_a_forearm_that_is_not_seen_is_dressed_as_what_is_seen_of_the_arm() -> None:
    colours = np.empty((ROWS, UNROLLED_COLUMNS, 3), np.float32)
    colours[:80], colours[80:] = COAT, SKIN
    source = np.zeros((ROWS, UNROLLED_COLUMNS), np.bool_)
    source[:20], source[85:] = True, True
    rows, _ = bare_rows(colours, source, TONE, 80)
    assert rows[85:].all() and not rows[:75].any()


def test_the_back_of_an_arm_that_shows_its_shade_is_as_bare_skin_is() -> None:
    facing = np.broadcast_to(np.cos(COLUMN_RADIANS), (ROWS, UNROLLED_COLUMNS)).astype(np.float32)
    source = facing > 0.22
    colours = np.where(source[..., None], np.array(SHADE, np.float32), 0)
    bare = BareRows(np.arange(ROWS) >= 60, np.array(SKIN, np.float32))
    found, _ = coloured_round(colours, source, facing, "mirror", None, True, False, bare)
    behind = np.abs(COLUMN_RADIANS) > 3
    assert np.abs(found[80:, behind] - SKIN).max() < np.abs(np.subtract(SKIN, SHADE)).max() / 2
    np.testing.assert_allclose(found[:40, behind], np.broadcast_to(SHADE, (40, int(behind.sum()), 3)), atol=3)
    assert (found[source] == SHADE).all()


def test_both_hands_and_arms_lie_alike_about_their_bones() -> None:
    left, right = hands_of_the_template()
    mirror = np.array([-1, 1, 1])
    np.testing.assert_allclose(left.along * mirror, right.along, atol=0.01)
    np.testing.assert_allclose(left.back * mirror, right.back, atol=0.01)
    parts = {part.name: part for part in unrolled_parts()}
    places = []
    for name, past in zip(("left_arm", "right_arm"), metres_past_wrists(), strict=True):
        part = parts[name]
        own = (past > -0.2) & (past < 0)  # a forearm
        places.append(
            (own.sum(), np.quantile(part.along[own], (0, 0.5, 1)), np.quantile(part.angle[own], (0.25, 0.75)))
        )
    assert abs(int(places[0][0]) - int(places[1][0])) < 5
    for of_left, of_right in zip(places[0][1:], places[1][1:], strict=True):
        np.testing.assert_allclose(of_left, of_right, rtol=0.05, atol=0.1)
