"""Rings of hair around a head that is an ellipsoid on the cylinder of its neck."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.hair.rings import HAIR_CLEARANCE_PIXELS, HairRings, hair_rings

HEIGHT, WIDTH = 170, 200
MIDDLE = np.array([100.0, 80.0, 0.0])
HALF = np.array([30.0, 40.0, 36.0])
"""Of the skull: pixels across, down and deep."""
NECK_RADIUS, STANDS_OFF, ENDS = 14.0, 10, 160
"""Pixels: the neck's radius, and by how much long hair is wider than the skull; and the row at which it ends."""


def skull() -> NDArray[np.float64]:
    """Points all over it (N, 3)."""
    height, turn = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(0, 2 * np.pi, 60, endpoint=False))
    around = np.sqrt(1 - height**2)
    unit = np.stack([around * np.sin(turn), height, around * np.cos(turn)], 2).reshape(-1, 3)
    return np.asarray(MIDDLE + HALF * unit)


def depths() -> NDArray[np.float64]:
    """How far the nearer half of head and neck is before their middle (h, w), -inf where they are not."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    head = 1 - ((x - MIDDLE[0]) / HALF[0]) ** 2 - ((y - MIDDLE[1]) / HALF[1]) ** 2
    neck = np.where(y > MIDDLE[1], NECK_RADIUS**2 - (x - MIDDLE[0]) ** 2, -1.0)
    either = np.maximum(HALF[2] * np.sqrt(np.maximum(head, 0)), np.sqrt(np.maximum(neck, 0)))
    return np.where((head > 0) | (neck > 0), either, -np.inf)


@pytest.fixture(scope="module")
def long_hair() -> HairRings:
    """A dome over the skull, and straight hair beside face and neck from there down."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    half = HALF[0] + STANDS_OFF
    top = MIDDLE[1] - HALF[1] - 4
    dome = (np.hypot(x - MIDDLE[0], y - top - half) < half) & (y < MIDDLE[1] - 0.5 * HALF[1])
    aside = np.abs(x - MIDDLE[0])
    straight = (aside < half) & (aside > 0.9 * HALF[0]) & (y > top + half / 2) & (y < ENDS)
    front = depths().astype(np.float32)
    return hair_rings(dome | straight, skull(), front, -front, MIDDLE[1] + HALF[1])


def test_the_back_of_long_hair_hangs_down_from_where_it_is_furthest(long_hair: HairRings) -> None:
    """A neck is narrower and nearer than the head above: hair does not follow it, but comes to hang straight from the head."""
    beside = (long_hair.rows > MIDDLE[1]) & (long_hair.rows < MIDDLE[1] + HALF[1] - 6)
    furthest = -HALF[2] - STANDS_OFF - HAIR_CLEARANCE_PIXELS
    np.testing.assert_allclose(long_hair.far[beside], furthest, atol=1.0)
    np.testing.assert_allclose(long_hair.far[-1], -HALF[2] - HAIR_CLEARANCE_PIXELS, atol=2.5)


def test_of_hair_that_falls_to_one_side_the_back_stands_off_as_on_the_other() -> None:
    """A head held aslant: on its left hair hangs 30 pixels away from it, on its right it lies on it."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    front = depths().astype(np.float32)
    beside = (y > MIDDLE[1] - 0.7 * HALF[1]) & (y < ENDS) & (np.abs(x - MIDDLE[0]) > 0.9 * HALF[0])
    on_the_head = np.isfinite(front) & (y < MIDDLE[1] - 0.5 * HALF[1])

    def behind(left: float, right: float) -> NDArray[np.float64]:
        hair = on_the_head | (beside & (x > MIDDLE[0] - HALF[0] - left) & (x < MIDDLE[0] + HALF[0] + right))
        return hair_rings(hair, skull(), front, -front, MIDDLE[1] + HALF[1]).far

    np.testing.assert_allclose(behind(30, 1), behind(1, 1), atol=1.0)
    assert (behind(1, 1) - behind(12, 12)).max() > 8


def test_they_close_above(long_hair: HairRings) -> None:
    first = long_hair.places(np.linspace(-np.pi, np.pi, 20))[0]
    assert np.hypot(first[:, 0] - MIDDLE[0], first[:, 2] - MIDDLE[2]).max() < 0.5


def test_places_are_on_its_ellipses(long_hair: HairRings) -> None:
    """Before, aside and behind it is where each quarter ends."""
    ahead, right, behind, left = long_hair.places(np.array([0, 0.5 * np.pi, np.pi, 1.5 * np.pi]))[40:].transpose(
        1, 0, 2
    )
    np.testing.assert_allclose(ahead[:, 2], long_hair.near[40:])
    np.testing.assert_allclose(behind[:, 2], long_hair.far[40:])
    np.testing.assert_allclose(right[:, 0], long_hair.right[40:])
    np.testing.assert_allclose(left[:, 0], long_hair.left[40:])


def test_its_outline_is_as_wide_as_it_is_seen(long_hair: HairRings) -> None:
    beside = (long_hair.rows > MIDDLE[1]) & (long_hair.rows < ENDS - 8)
    for aside in (long_hair.axis - long_hair.left, long_hair.right - long_hair.axis):
        np.testing.assert_allclose(aside[beside], HALF[0] + STANDS_OFF, atol=1.0)


def test_short_hair_keeps_to_the_head_down_to_the_nape() -> None:
    """The neck is nearer than the head above it, and hair that ends there lies on it: it does not hang."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    cap = (((x - MIDDLE[0]) / HALF[0]) ** 2 + ((y - MIDDLE[1]) / HALF[1]) ** 2 < 1) & (y < MIDDLE[1] - 12)
    front = depths().astype(np.float32)
    short = hair_rings(cap, skull(), front, -front, MIDDLE[1] + HALF[1] - 1)
    assert short.far[-1] > -NECK_RADIUS - 8
    assert short.far.min() < -0.9 * HALF[2]


def test_a_flat_top_is_a_dome_in_depth() -> None:
    """A hat whose outline is as wide from its first row on: seen from the side it is no box."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    hat = (np.abs(x - MIDDLE[0]) < HALF[0]) & (y > 30) & (y < MIDDLE[1])
    front = depths().astype(np.float32)
    rings = hair_rings(hat, skull(), front, -front, MIDDLE[1] + 10)
    deep = rings.near - rings.far
    third = int(np.argmax(rings.rows > 33))
    assert deep[third] < 0.75 * deep[int(np.argmax(rings.rows > 50))]
