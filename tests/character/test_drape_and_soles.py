"""Cloth that hangs freely, and soles: forms whose depth is known."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from engine.character.drape import ROUND, drape
from engine.character.labels import PARTS
from engine.character.part_surface import Surface
from engine.character.sheets import Layer
from engine.character.soles import with_soles

HEIGHT, WIDTH, MIDDLE = 200, 120, 60
WAIST, CROTCH, HEM, ANKLES = 80, 100, 150, 185.0


def body() -> tuple[np.ndarray, np.ndarray]:
    """A trunk 24 wide over two legs of 10 with a gap of 4: its parts (h, w), and how deep it is to each side."""
    shown = np.full((HEIGHT, WIDTH), -1)
    shown[30 : CROTCH + 1, MIDDLE - 12 : MIDDLE + 12] = PARTS.index("torso")
    shown[CROTCH + 1 : 195, MIDDLE - 12 : MIDDLE - 2] = PARTS.index("right_leg")
    shown[CROTCH + 1 : 195, MIDDLE + 2 : MIDDLE + 12] = PARTS.index("left_leg")
    return shown, np.where(shown >= 0, 8.0, np.nan)


def worn(mask: np.ndarray) -> Layer:
    """A layer 8 pixels deep to each side all over."""
    sides = [np.where(mask, depth, np.nan).astype(np.float32) for depth in (8, -8)]
    weights = np.zeros((*mask.shape, 1), np.float32)
    return Layer(mask, *(Surface(side, weights) for side in sides), np.zeros(mask.shape, np.int8))


def skirt(shown: np.ndarray) -> np.ndarray:
    """The body's mask with a skirt that widens from the waist by half a pixel a row to each side."""
    mask = shown >= 0
    for row in range(WAIST, HEM):
        half = 12 + (row - WAIST) // 2
        mask[row, MIDDLE - half : MIDDLE + half] = True
    return mask


def test_a_skirt_is_as_round_as_hips() -> None:
    shown, depth = body()
    mask = skirt(shown)
    draped = drape(worn(mask), mask, shown, depth, -depth, np.zeros_like(mask), ANKLES)
    thick = draped.front.depth - draped.back.depth
    for row in (HEM - 20, HEM - 8):
        width = mask[row].sum()
        assert thick[row, MIDDLE] == pytest.approx(ROUND * width, rel=0.08)
        edge = np.flatnonzero(mask[row])[0]
        assert thick[row, edge] < 2, "front and back meet at the outline"
    assert (np.diff(thick[WAIST:HEM, MIDDLE]) > -0.1).all(), "it hangs: downwards it gets no thinner"
    np.testing.assert_allclose(thick[:WAIST][mask[:WAIST]], 16, atol=0.05)
    np.testing.assert_array_equal(thick[HEM + 1 :][mask[HEM + 1 :]], 16)


def test_a_hem_that_hangs_lower_beside_the_legs_goes_on() -> None:
    shown, depth = body()
    mask = skirt(shown)
    mask[HEM : HEM + 10, MIDDLE - 46 : MIDDLE - 20] = True
    draped = drape(worn(mask), mask, shown, depth, -depth, np.zeros_like(mask), ANKLES)
    column = MIDDLE - 28
    assert draped.front.depth[HEM + 5, column] == pytest.approx(draped.front.depth[HEM - 2, column], abs=1.5)
    assert draped.front.depth[HEM + 5, MIDDLE - 6] == 8, "the leg beside it is the leg"


def test_trousers_are_no_skirt() -> None:
    shown, depth = body()
    mask = shown >= 0
    mask[CROTCH:195, MIDDLE - 14 : MIDDLE + 14] = True
    parting = np.zeros_like(mask)
    parting[CROTCH + 4 : 195, MIDDLE] = True
    before = worn(mask)
    after = drape(before, mask, shown, depth, -depth, parting, ANKLES)
    assert np.nanmax(np.abs(after.front.depth - before.front.depth)) < 1


def test_nobody_without_legs_wears_a_skirt() -> None:
    shown, depth = body()
    shown = np.where(shown == PARTS.index("torso"), shown, -1)
    mask = shown >= 0
    before = worn(mask)
    assert drape(before, mask, shown, depth, -depth, np.zeros_like(mask), ANKLES) is before


def foot() -> trimesh.Trimesh:
    """A block 26 cm long whose heel is 5 cm above its toes."""
    mesh = trimesh.creation.box((0.09, 0.06, 0.26))
    for _ in range(4):
        mesh = mesh.subdivide()
    mesh.vertices[:, 1] += 0.03 + (0.13 - mesh.vertices[:, 2]) * 0.05 / 0.26
    return mesh


def test_an_underside_lies_on_the_ground() -> None:
    mesh = foot()
    place, normal = np.asarray(mesh.vertices), mesh.vertex_normals
    lying = with_soles(
        place, mesh.faces, np.zeros(len(place), int), np.ones(len(place), bool), lambda which, places: which >= 0
    )
    under = normal[:, 1] < -0.9
    assert under.sum() > 50
    assert np.ptp(lying[under, 1]) < 1e-9
    np.testing.assert_array_equal(lying[normal[:, 1] > -0.3], place[normal[:, 1] > -0.3])
    np.testing.assert_array_equal(lying[:, [0, 2]], place[:, [0, 2]])


def test_what_the_picture_shows_stays() -> None:
    mesh = foot()
    place, own = np.asarray(mesh.vertices), np.zeros(len(mesh.vertices), int)
    hidden = place[:, 0] < 0
    half_way = 0.02
    lying = with_soles(place, mesh.faces, own, hidden, lambda which, places: places[:, 1] > half_way)
    np.testing.assert_array_equal(lying[~hidden], place[~hidden])
    assert lying[(lying != place).any(1), 1].min() > half_way, "and nothing comes where it would be seen"
    assert not np.array_equal(lying, place)
    neither = with_soles(place, mesh.faces, own - 1, ~hidden | hidden, lambda which, places: which >= 0)
    np.testing.assert_array_equal(neither, place)
