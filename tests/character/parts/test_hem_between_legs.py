"""Hems seen between legs: a skirt ends there at once, trousers part in a wedge."""

from __future__ import annotations

import numpy as np

from engine.body.parts import BODY_PARTS
from engine.character.parts.free_cloth import free_cloth
from engine.character.parts.hem_between_legs import hem_between_legs

HEIGHT, WIDTH, MIDDLE, CROTCH, KNEES, FEET = 240, 160, 80, 100, 160, 235
RED, SKIN = (180, 30, 40), (225, 180, 150)


def legs(apart: float) -> tuple[np.ndarray, np.ndarray]:
    """Legs 14 wide whose inner edges are `apart` pixels further from each other with each row, (h, w) each."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    inner = np.maximum(y - CROTCH, 0) * apart / 2
    below = (y > CROTCH) & (y < FEET)
    right = below & (x <= MIDDLE - inner) & (x > MIDDLE - 14 - inner)
    left = below & (x >= MIDDLE + 1 + inner) & (x < MIDDLE + 15 + inner)
    return left, right


def skirted(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Legs (h, w) and a skirt that is no wider than they reach, down to the knees."""
    cloth = left | right
    for row in range(CROTCH + 1, KNEES + 1):
        there = np.flatnonzero(cloth[row])
        cloth[row, there[0] : there[-1] + 1] = True
    return cloth


def coloured(beneath: tuple[int, int, int]) -> np.ndarray:
    """Red cloth down to the knees, and what is `beneath`, (h, w, 3)."""
    rgb = np.full((HEIGHT, WIDTH, 3), RED, np.uint8)
    rgb[KNEES + 1 :] = beneath
    return rgb


def test_a_skirt_ends_where_its_hem_is() -> None:
    left, right = legs(0.3)
    assert hem_between_legs(coloured(SKIN), skirted(left, right), left, right) == KNEES


def test_a_gap_that_no_trousers_fill_needs_no_other_colours() -> None:
    left, right = legs(1.2)
    assert hem_between_legs(coloured(RED), skirted(left, right), left, right) == KNEES
    narrow = legs(0.3)
    assert hem_between_legs(coloured(RED), skirted(*narrow), *narrow) is None, "baggy trousers part at once, too"


def test_shorts_part_in_a_wedge() -> None:
    left, right = legs(0.3)
    cloth = skirted(left, right)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    cloth &= (y <= CROTCH + 20) | (abs(x - MIDDLE) > (y - CROTCH - 20) * 0.25) | left | right
    assert hem_between_legs(coloured(SKIN), cloth, left, right) is None


def test_legs_that_touch_have_none() -> None:
    left, right = legs(0.0)
    assert hem_between_legs(coloured(SKIN), left | right, left, right) is None


def test_a_skirt_as_wide_as_the_legs_hangs_down_to_it_past_cracks() -> None:
    left, right = legs(1.2)
    trunk = np.zeros((HEIGHT, WIDTH), np.bool_)
    trunk[30 : CROTCH + 1, MIDDLE - 13 : MIDDLE + 15] = True
    shown = np.select([trunk, left, right], [BODY_PARTS.index(name) for name in ("torso", "left_leg", "right_leg")], -1)
    mask = skirted(left, right) | trunk
    mask[130:134, MIDDLE - 2 : MIDDLE + 2] = False
    depth = np.where(shown >= 0, 8.0, np.nan)
    plain = np.zeros_like(mask)
    cloth = free_cloth(mask, shown, depth, -depth, plain, hem=hem_between_legs(coloured(SKIN), mask, left, right))
    assert cloth is not None and cloth.hangs and cloth.rings[-1].row == KNEES
    without = free_cloth(mask, shown, depth, -depth, plain)
    assert without is None or without.rings[-1].row < 134
