"""What goes round a part: of rolls of cloth whose back is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.shell.colours.round import (
    COLUMN_RADIANS,
    COLUMN_SINES,
    coloured_round,
    reflections,
    row_model,
    with_the_other,
)
from engine.character.shell.colours.unrolled import UNROLLED_COLUMNS

ROWS = 160
NAVY, RED, WHITE = np.array([20, 30, 60]), np.array([220, 30, 40]), np.array([235, 235, 230])
FACING = np.broadcast_to(np.cos(COLUMN_RADIANS), (ROWS, UNROLLED_COLUMNS)).astype(np.float32)
SOURCE = FACING > 0.22
BEHIND = FACING < -0.3


def roll(*bands: tuple[slice, NDArray[np.int_]], ground: NDArray[np.int_] = NAVY) -> NDArray[np.float32]:
    cloth = np.empty((ROWS, UNROLLED_COLUMNS, 3), np.float32)
    cloth[:] = ground
    for rows, colour in bands:
        cloth[rows] = colour
    return cloth


def painted(cloth: NDArray[np.float32], **more: object) -> NDArray[np.float32]:
    nothing = np.full(3, 255, np.float32)
    return coloured_round(np.where(SOURCE[..., None], cloth, nothing), SOURCE, FACING, **more)[0]  # type: ignore[arg-type]


def test_stripes_go_round_and_what_is_seen_stays() -> None:
    cloth = roll(*((slice(first, first + 10), WHITE) for first in range(5, ROWS, 20)))
    found = painted(cloth)
    assert (found[SOURCE] == cloth[SOURCE]).all()
    within = np.ones(ROWS, np.bool_)
    within[[row + k for row in range(5, ROWS, 10) for k in range(-4, 4) if row + k < ROWS]] = False  # borders are soft
    assert np.abs(found - cloth)[within].max() < 12


def test_a_tie_is_not_on_the_back_but_for_whoever_wants_the_front_mirrored() -> None:
    cloth = roll()
    tie = np.broadcast_to(np.abs(COLUMN_SINES) < 0.15, SOURCE.shape) & (FACING > 0) & (np.arange(ROWS) > 40)[:, None]
    cloth[tie] = RED
    found = painted(cloth)
    assert (np.abs(found[BEHIND] - NAVY).max(-1) > 6).mean() < 0.002  # but for its corners
    assert (found[tie & SOURCE] == RED).all()
    mirrored = painted(cloth, back="mirror")
    assert (np.abs(mirrored - RED).max(-1) < 6)[BEHIND].sum() == pytest.approx(tie.sum(), rel=0.05)


def test_checks_are_on_the_back_as_on_the_front_and_inpainted_ones_are_not() -> None:
    checks = ((np.arange(ROWS)[:, None] // 8 + np.arange(UNROLLED_COLUMNS) // 8) % 2)[..., None]
    cloth = (checks * WHITE + (1 - checks) * np.array([150, 150, 150])).astype(np.float32)
    contrast = {back: painted(cloth, back=back)[BEHIND].std() for back in ("see_through", "inpaint")}
    assert contrast["see_through"] > 0.8 * cloth.std() > 5 * contrast["inpaint"] - 20


def test_light_from_one_side_has_no_border_behind() -> None:
    light = (0.6 + 0.4 * COLUMN_SINES)[None, :, None]
    found = painted((light * np.array([180, 160, 140])).repeat(ROWS, 0).astype(np.float32))
    row = found[ROWS // 2, :, 0]
    assert np.abs(np.diff(row, append=row[:1])).max() < 6
    assert np.abs(found[BEHIND] - (light * [180, 160, 140]).repeat(ROWS, 0)[BEHIND]).max() < 20


def test_a_sleeve_ends_where_it_does_though_only_half_of_its_rows_are_seen() -> None:
    cloth = roll((slice(0, 80), WHITE))
    source = SOURCE & ((np.arange(ROWS) < 60) | (np.arange(ROWS) > 84))[:, None]
    found, sure = coloured_round(cloth, source, FACING)
    assert np.abs(found[:56] - WHITE).max() < 6 and np.abs(found[90:] - NAVY).max() < 6
    assert sure[:50].min() == 1 and sure[70] == 0


def test_nothing_seen_is_nothing_changed() -> None:
    cloth = roll()
    found, sure = coloured_round(cloth, np.zeros_like(SOURCE), FACING)
    assert (found == cloth).all() and not sure.any()


def test_whoever_is_turned_has_a_tie_seen_aside_not_on_the_back() -> None:
    turned = UNROLLED_COLUMNS // 8
    cloth = roll()
    cloth[:, np.abs(COLUMN_SINES * (np.cos(COLUMN_RADIANS) > 0) + 2 * (np.cos(COLUMN_RADIANS) <= 0)) < 0.1] = RED
    facing, source = np.roll(FACING, turned, 1), np.roll(SOURCE, turned, 1)
    found = coloured_round(cloth, source, facing)[0]
    assert np.abs(found[np.roll(BEHIND, turned, 1)] - NAVY).max() < 8


def test_what_is_hidden_of_a_sleeve_is_as_the_other_side_s() -> None:
    other = roll((slice(0, 80), WHITE), (slice(120, ROWS), RED))
    other[:, (COLUMN_RADIANS > 0.2) & (COLUMN_RADIANS < 0.5)] = WHITE
    hidden = (np.arange(ROWS) > 40)[:, None] & np.ones_like(SOURCE)
    own = other[:, ::-1].copy()
    own[hidden] = 255
    colours, source, facing = with_the_other((own, SOURCE & ~hidden, FACING), (other, SOURCE, FACING))
    seen = SOURCE[:, ::-1]
    assert (colours[seen] == other[:, ::-1][seen]).all() and (source == SOURCE).all() and (facing == FACING).all()


def test_what_is_seen_of_a_sleeve_is_its_own() -> None:
    own = roll(), SOURCE, FACING
    for found, before in zip(with_the_other(own, (roll(ground=RED), SOURCE, FACING)), own, strict=True):
        assert (found == before).all()


def test_folds_of_a_sleeve_make_no_rings() -> None:
    """Shadows of folds, 1 cm high, across all that is seen, and a cuff."""
    cloth = roll((slice(0, 20), WHITE), *((slice(row, row + 4), NAVY + 24) for row in range(50, ROWS, 30)))
    found = coloured_round(np.where(SOURCE[..., None], cloth, 0), SOURCE, FACING, "inpaint", ring=True)[0]
    behind = found[:, 0].mean(-1)
    assert np.ptp(behind[30:]) < 12
    assert np.abs(found[:14, 0] - WHITE).max() < 6


def test_a_limb_of_which_one_side_is_seen_is_a_ring_of_that() -> None:
    cloth = roll((slice(0, 80), WHITE))
    left = np.broadcast_to(COLUMN_RADIANS < 0, SOURCE.shape) & SOURCE
    source = np.where((np.arange(ROWS) < 70)[:, None], SOURCE & ~left, SOURCE)
    found = coloured_round(cloth, source, FACING, ring=True)[0]
    assert np.abs(found[:64] - WHITE).max() < 6


def test_a_limb_of_which_a_strip_of_its_middle_is_seen_is_a_ring_of_that() -> None:
    cloth = roll((slice(0, 80), WHITE))
    strip = np.broadcast_to(np.abs(COLUMN_RADIANS) < 0.12, SOURCE.shape)
    source = np.where((np.arange(ROWS) < 84)[:, None], SOURCE & strip, SOURCE)
    found = coloured_round(cloth, source, FACING, ring=True)[0]
    assert np.abs(found[:70] - WHITE).max() < 6


def test_what_a_leg_shows_is_reflected_at_its_border() -> None:
    """Known are 60 degrees to both sides of the middle; as far beyond as within, the same column is meant, and both sides' shares are all."""
    half = UNROLLED_COLUMNS // 6
    known = np.zeros((60, UNROLLED_COLUMNS), np.bool_)
    known[:, UNROLLED_COLUMNS // 2 - half : UNROLLED_COLUMNS // 2 + half + 1] = True
    (right, of_right), (left, of_left) = reflections(known)
    np.testing.assert_allclose(of_right + of_left, 1, atol=1e-6)
    assert (right[known] == np.broadcast_to(np.arange(UNROLLED_COLUMNS), known.shape)[known]).all()
    border = UNROLLED_COLUMNS // 2 + half
    for beyond in (1, 10, half):
        assert (right[:, border + beyond] == border - beyond).all()
    inside = known[0]
    assert inside[right].all() and inside[left].all()
    assert (of_right[:, border + 20] == 1).all() and (of_left[:, UNROLLED_COLUMNS - border - 20] == 1).all()


def test_a_legs_folds_have_no_seam_at_the_border() -> None:
    columns = np.arange(UNROLLED_COLUMNS)
    folds = 120 + 30 * np.sin(columns / 5.0)
    colours = np.broadcast_to(folds[None, :, None], (80, UNROLLED_COLUMNS, 3)).astype(np.float32)
    angle = (columns + 0.5) / UNROLLED_COLUMNS * 2 * np.pi - np.pi
    facing = np.broadcast_to(np.cos(angle), (80, UNROLLED_COLUMNS)).astype(np.float32)
    source = facing > 0.4
    filled, _ = coloured_round(np.where(source[..., None], colours, 0), source, facing, "mirror", None, True, True)
    steps = np.abs(np.diff(filled[40, :, 0]))
    assert steps.max() < 1.3 * np.abs(np.diff(folds)).max()
    side = (facing[40] < 0.35) & (facing[40] > -0.35)
    assert filled[40, side, 0].std() > 10, "folds go on over the sides"


def test_a_side_of_which_nothing_is_seen_is_as_the_other() -> None:
    seen = np.full((40, UNROLLED_COLUMNS, 3), [10, 100, 50], np.float32)
    weight = np.broadcast_to(np.maximum(COLUMN_SINES, 0), seen.shape[:2])
    np.testing.assert_allclose(row_model(seen, weight).colours, seen, atol=0.01)
