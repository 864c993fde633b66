"""Where around a head there is hair: a head that is an ellipsoid on its neck, and hair that is drawn on it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.character.hair.extent import HeadLevels, hair_extent
from engine.character.hair.rings import HairRings, hair_rings
from tests.character.hair.test_hair_rings import HALF, HEIGHT, MIDDLE, WIDTH, depths, skull

ANGLES = np.linspace(-np.pi, np.pi, 65)
LEVELS = HeadLevels(ears=MIDDLE[1], nape=MIDDLE[1] + 0.6 * HALF[1], chin=MIDDLE[1] + HALF[1])
rows, columns = np.mgrid[:HEIGHT, :WIDTH]
head = ((columns - MIDDLE[0]) / HALF[0]) ** 2 + ((rows - MIDDLE[1]) / HALF[1]) ** 2 < 1
cap = head & (rows < MIDDLE[1] - 0.3 * HALF[1])
"""Short hair: ears, and all below, are skin."""


def extent(hair: NDArray[np.bool_]) -> tuple[HairRings, NDArray[np.float64]]:
    """The rings of hair (h, w), and how surely it is at even angles."""
    front = depths().astype(np.float32)
    of = hair_rings(hair, skull(), front, -front, LEVELS.nape)
    return of, hair_extent(hair, np.isfinite(front), of, of.places(ANGLES), ANGLES, LEVELS)


def at(found: tuple[HairRings, NDArray[np.float64]], row: float, degrees: float) -> float:
    of, values = found
    column = int(np.abs(ANGLES - np.radians(degrees)).argmin())
    return float(values[int(np.abs(of.rows - row).argmin()), column])


def test_short_hair_begins_behind_the_ear_and_ends_at_the_nape() -> None:
    found = extent(cap)
    for side in (-1, 1):
        assert at(found, LEVELS.ears, side * 80) < 0, "an ear"
        assert at(found, LEVELS.ears, side * 140) > 0, "behind it"
        assert at(found, MIDDLE[1] - 0.5 * HALF[1], side * 80) > 0, "above it"
    assert at(found, LEVELS.nape - 4, 180) > 0
    assert found[0].rows[-1] <= LEVELS.nape + 1


@pytest.mark.parametrize(("radius", "is_hair"), [(1.5, True), (5, False)], ids=["a speck", "an ear"])
def test_a_gap_is_one_from_a_size_on(radius: float, is_hair: bool) -> None:
    place = MIDDLE[0] + 12, MIDDLE[1] - 0.5 * HALF[1]
    found = extent(cap & ~(np.hypot(columns - place[0], rows - place[1]) < radius))
    aside = np.degrees(np.arcsin(12 / (found[0].right[int(place[1] - found[0].rows[0])] - MIDDLE[0])))
    assert (at(found, place[1], float(aside)) > 0) == is_hair


def test_above_the_crown_hair_is_all_round() -> None:
    """Though its uppermost rows are narrower than what is seen of the head there, by a blurred mask."""
    top = MIDDLE[1] - HALF[1]
    found = extent(cap & ~((rows < top + 8) & (np.abs(columns - MIDDLE[0]) > 6)))
    for degrees in (-170, -120, 120, 170):
        assert at(found, top + 5, degrees) > 0


def test_long_hair_is_as_long_behind_as_on_its_shorter_side() -> None:
    chin = LEVELS.chin
    beside = (
        (np.abs(columns - MIDDLE[0]) < HALF[0] + 4)
        & (np.abs(columns - MIDDLE[0]) > 0.9 * HALF[0])
        & (rows > MIDDLE[1] - 12)
    )
    left, right = (rows < chin + 12) & (columns < MIDDLE[0]), (rows < chin + 35) & (columns > MIDDLE[0])
    found = extent(cap | (beside & (left | right)))
    assert at(found, chin + 6, 180) > 0 > at(found, chin + 20, 180)
    assert at(found, chin + 25, 90) > 0 > at(found, chin + 25, -90)
