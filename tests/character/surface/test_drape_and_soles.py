"""Cloth that hangs freely, and soles: forms whose depth is known."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
import trimesh

from engine.body.parts import BODY_PARTS
from engine.character.fit.template_fit import load_human
from engine.character.parts.free_cloth import CLOTH_DEPTH_RATIO, FreeCloth, free_cloth
from engine.character.surface.drape import drape
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface
from engine.character.surface.skirt_weights import MIN_LEG_BLEND_SHARE, moved_by_both
from engine.character.surface.soles import with_soles

HEIGHT, WIDTH, MIDDLE = 200, 120, 60
WAIST, CROTCH, HEM = 80, 100, 150
RIG = load_human().rig


def body() -> tuple[np.ndarray, np.ndarray]:
    """A trunk 24 wide over two legs of 10 with a gap of 4: its parts (h, w), and how deep it is to each side."""
    shown = np.full((HEIGHT, WIDTH), -1)
    shown[30 : CROTCH + 1, MIDDLE - 12 : MIDDLE + 12] = BODY_PARTS.index("torso")
    shown[CROTCH + 1 : 195, MIDDLE - 12 : MIDDLE - 2] = BODY_PARTS.index("right_leg")
    shown[CROTCH + 1 : 195, MIDDLE + 2 : MIDDLE + 12] = BODY_PARTS.index("left_leg")
    return shown, np.where(shown >= 0, 8.0, np.nan)


def worn(mask: np.ndarray) -> Layer:
    """A layer 8 pixels deep to each side all over; the trunk moves what is above the crotch, each leg what is beneath on its
    side of the middle."""
    sides = [np.where(mask, depth, np.nan).astype(np.float32) for depth in (8, -8)]
    weights = np.zeros((*mask.shape, len(RIG.names)), np.float32)
    weights[:CROTCH, :, RIG.index("Hips")] = 1
    weights[CROTCH:, :MIDDLE, RIG.index("RightUpLeg")] = 1
    weights[CROTCH:, MIDDLE:, RIG.index("LeftUpLeg")] = 1
    return Layer(mask, *(Surface(side, weights) for side in sides))


def skirt(shown: np.ndarray) -> np.ndarray:
    """The body's mask with a skirt that widens from the waist by half a pixel a row to each side."""
    mask = shown >= 0
    for row in range(WAIST, HEM):
        half = 12 + (row - WAIST) // 2
        mask[row, MIDDLE - half : MIDDLE + half] = True
    return mask


def trousers(shown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The body's mask in trousers whose legs touch, and where they do (h, w)."""
    mask = shown >= 0
    mask[CROTCH:195, MIDDLE - 14 : MIDDLE + 14] = True
    parting = np.zeros_like(mask)
    parting[CROTCH + 4 : 195, MIDDLE] = True
    return mask, parting


def found_in(mask: np.ndarray, parting: np.ndarray | None = None) -> FreeCloth | None:
    shown, depth = body()
    return free_cloth(mask, shown, depth, -depth, np.zeros_like(mask) if parting is None else parting)


def test_a_skirt_ends_in_its_hem() -> None:
    shown, _ = body()
    for mask in (skirt(shown), skirt(shown) | (np.arange(HEIGHT) >= 180)[:, None] & cv2.dilate(
            (shown >= 0).astype(np.uint8), np.ones((1, 15), np.uint8)).astype(bool)):  # fmt: skip
        cloth = found_in(mask)
        assert cloth is not None and cloth.hangs and not cloth.goes_on, "with wide shoes or without"
        assert abs(cloth.rings[-1].row - HEM) <= 2
        assert abs(cloth.rings[cloth.above].row - CROTCH) <= 2


def gown(shown: np.ndarray, end: int) -> tuple[np.ndarray, np.ndarray]:
    """The body's mask in a gown that is close at the thighs and ends at a row, and a line between the legs (h, w)."""
    mask, line = shown >= 0, np.zeros(shown.shape, np.bool_)
    for row in range(WAIST, end):
        half = 12 + (row - WAIST) // 8
        mask[row, MIDDLE - half : MIDDLE + half] = True
    line[CROTCH + 4 : end, MIDDLE] = True
    return mask, line


@pytest.mark.parametrize("end", [150, 175, 190, 195])
def test_lines_between_the_legs_of_a_gown_are_folds(end: int) -> None:
    shown, _ = body()
    mask, line = gown(shown, end)
    if end == 190:
        mask[end:] = False  # the picture's edge
    cloth = found_in(mask, line)
    assert cloth is not None and cloth.hangs, "to the ground, too"
    assert abs(cloth.rings[-1].row - end) <= 2


def test_nobody_in_a_mask_wears_nothing() -> None:
    assert found_in(np.zeros((HEIGHT, WIDTH), np.bool_)) is None


def test_a_skirt_is_as_round_as_hips() -> None:
    shown, _ = body()
    mask = skirt(shown)
    cloth = found_in(mask)
    assert cloth is not None
    draped = drape(worn(mask), cloth)
    thick = draped.front.depth - draped.back.depth
    for row in (HEM - 20, HEM - 8):
        width = mask[row].sum()
        assert thick[row, MIDDLE] == pytest.approx(CLOTH_DEPTH_RATIO * width, rel=0.08)
        edge = np.flatnonzero(mask[row])[0]
        assert thick[row, edge] < 2, "front and back meet at the outline"
    assert (np.diff(thick[WAIST:HEM, MIDDLE]) > -0.1).all(), "it hangs: downwards it gets no thinner"
    np.testing.assert_allclose(thick[:WAIST][mask[:WAIST]], 16, atol=0.05)
    np.testing.assert_array_equal(thick[HEM + 1 :][mask[HEM + 1 :]], 16)


def test_a_hem_that_hangs_lower_beside_the_legs_goes_on() -> None:
    shown, _ = body()
    mask = skirt(shown)
    mask[HEM : HEM + 10, MIDDLE - 46 : MIDDLE - 20] = True
    cloth = found_in(mask)
    assert cloth is not None
    draped = drape(worn(mask), cloth)
    column = MIDDLE - 28
    assert draped.front.depth[HEM + 5, column] == pytest.approx(draped.front.depth[HEM - 2, column], abs=1.5)
    assert draped.front.depth[HEM + 5, MIDDLE - 6] == 8, "the leg beside it is the leg"


def test_a_skirt_goes_over_from_leg_to_leg() -> None:
    shown, _ = body()
    mask = skirt(shown)
    cloth = found_in(mask)
    assert cloth is not None
    before = worn(mask)
    moved = moved_by_both(before, cloth, RIG, before)
    left = moved.front.weights[..., RIG.index("LeftUpLeg")]
    for surface in (moved.front, moved.back):
        np.testing.assert_allclose(surface.weights[mask].sum(1), 1, atol=1e-5)
    row = left[HEM - 5][mask[HEM - 5]]
    step = np.diff(row)
    assert row[0] == 0 and row[-1] == 1 and (step > -1e-6).all(), "the ends go with one leg each"
    assert step.max() < 1.2 / (MIN_LEG_BLEND_SHARE * len(row)), "and between them nothing jumps"
    assert row[len(row) // 2 - 1 : len(row) // 2 + 1].mean() == pytest.approx(0.5, abs=0.01)
    low = HEM + 30
    np.testing.assert_array_equal(left[low], before.front.weights[low, :, RIG.index("LeftUpLeg")])
    below = left[HEM - 1 : low, MIDDLE - 4]
    assert np.abs(np.diff(below)).max() < 0.1, "legs that come from under the hem are not torn from it"


def test_of_somebody_seen_from_behind_the_left_leg_is_at_the_left() -> None:
    shown, depth = body()
    cloth = free_cloth(skirt(shown), shown[:, ::-1], depth, -depth, np.zeros(shown.shape, np.bool_))
    assert cloth is not None
    before = worn(skirt(shown))
    front, back = (replace(side, weights=side.weights[:, ::-1]) for side in (before.front, before.back))
    turned = replace(before, front=front, back=back)
    row = moved_by_both(turned, cloth, RIG, turned).front.weights[HEM - 5][cloth.worn[HEM - 5]]
    assert row[0, RIG.index("LeftUpLeg")] == 1 and row[-1, RIG.index("RightUpLeg")] == 1


def test_a_hem_over_legs_that_have_changed_sides_goes_with_both_alike() -> None:
    """Somebody who strides, seen from the side. With each leg it would be turned inside out as they go on."""
    shown, depth = body()
    crossed = shown.copy()
    crossed[CROTCH + 10 :] = shown[CROTCH + 10 :, ::-1]
    cloth = free_cloth(skirt(shown), crossed, depth, -depth, np.zeros(shown.shape, np.bool_))
    assert cloth is not None
    left = moved_by_both(worn(skirt(shown)), cloth, RIG, worn(skirt(shown))).front.weights[..., RIG.index("LeftUpLeg")]
    np.testing.assert_allclose(left[HEM - 2][skirt(shown)[HEM - 2]], 0.5, atol=0.06)
    assert np.ptp(left[CROTCH + 2][skirt(shown)[CROTCH + 2]]) > 0.5, "at the hips each moves its side"


def test_a_hem_goes_over_between_the_legs_that_come_out_of_it() -> None:
    """Both legs at the viewer's left of a wide skirt: around each it goes with that one."""
    shown, depth = body()
    aside = np.roll(shown, -14, 1)
    mask = skirt(shown) | (aside >= 0)
    cloth = free_cloth(mask, aside, np.roll(depth, -14, 1), -np.roll(depth, -14, 1), np.zeros(shown.shape, np.bool_))
    assert cloth is not None
    left = moved_by_both(worn(mask), cloth, RIG, worn(mask)).front.weights[HEM - 2, :, RIG.index("LeftUpLeg")]
    assert left[MIDDLE - 14] == pytest.approx(0.5, abs=0.1), "between them"
    assert left[MIDDLE - 21] < 0.3 and left[MIDDLE - 7] > 0.7


def test_a_hand_beside_a_hem_stays_a_hand() -> None:
    shown, _ = body()
    mask = skirt(shown)
    before = worn(mask)
    hand = np.zeros_like(mask)
    hand[40 : HEM + 14, 5:11] = True
    before.mask[hand] = True
    for side in (before.front, before.back):
        side.weights[hand] = np.eye(len(RIG.names))[RIG.index("RightHand")]
    cloth = found_in(mask & ~hand)
    assert cloth is not None
    moved = moved_by_both(before, cloth, RIG, before)
    assert (moved.front.weights[hand][:, RIG.index("RightHand")] == 1).all()


def test_trousers_are_no_skirt() -> None:
    shown, _ = body()
    mask, parting = trousers(shown)
    cloth = found_in(mask, parting)
    before = worn(mask)
    assert cloth is not None and not cloth.hangs and cloth.goes_on
    after = moved_by_both(drape(before, cloth), cloth, RIG, before)
    assert np.nanmax(np.abs(after.front.depth - before.front.depth)) < 1
    assert np.abs(after.front.weights - before.front.weights)[CROTCH + 8 :].max() < 1e-6


def test_nobody_without_legs_wears_a_skirt() -> None:
    shown, depth = body()
    shown = np.where(shown == BODY_PARTS.index("torso"), shown, -1)
    mask = shown >= 0
    assert free_cloth(mask, shown, depth, -depth, np.zeros_like(mask)) is None


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
