"""Colours of a character where the picture has none: behind arms, at the sides, on the back."""

from __future__ import annotations

import cv2
import numpy as np

from engine.body.parts import BODY_PARTS
from engine.character.figure.face_region import face_within
from engine.character.parts.label_map import Labels
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.part_surface import Surface
from engine.character.texture.limb_texture import LimbSurfaces, of_the_limbs, paint_limbs
from engine.character.texture.sides import FOLD_SHARE, MAX_FOLD_PIXELS, places_on_the_picture
from engine.character.texture.texture import PictureOnGrid, joined_at_the_outline, paint_tiles

SAME = np.array([[1.0, 0, 0], [0, 1, 0]])
GREEN, RED, BROWN, SKIN = (20, 160, 60), (210, 40, 30), (70, 45, 30), (230, 180, 150)


def person() -> tuple[np.ndarray, np.ndarray]:
    """A round head with hair above and a face, a dress with an arm before it, on a red wall; and its labels."""
    labels = np.full((240, 160), -1)
    labels[90:220, 40:120] = BODY_PARTS.index("torso")
    cv2.circle(head := np.zeros((240, 160), np.uint8), (80, 50), 38, (1,), -1)
    labels[head > 0] = BODY_PARTS.index("head")
    rgb = np.empty((240, 160, 3), np.uint8)
    rgb[:] = RED
    rgb[labels == BODY_PARTS.index("torso")] = GREEN
    rgb[(labels == BODY_PARTS.index("head"))] = SKIN
    rgb[:40][labels[:40] == BODY_PARTS.index("head")] = BROWN
    labels[140:165, 40:100] = BODY_PARTS.index("right_arm")
    rgb[140:165, 40:100] = SKIN
    return rgb, labels


FACE = (80, 58, 22, 26, 0)


def painted(  # type: ignore[no-untyped-def]
    back: str = "mirror",
    shows: bool = True,
    face: tuple[float, ...] = FACE,
    hand: tuple[int, int] | None = None,
    along=None,
):
    rgb, labels = person()
    none = np.zeros(labels.shape, np.bool_)
    apart = np.array([BODY_PARTS.index("right_arm")], np.int8)
    alpha = (labels >= 0).astype(np.float32)
    reach = np.zeros(labels.shape, np.bool_)
    reach[140:165, 40:115] = True  # behind the dress, too
    hidden = np.full(labels.shape, -1, np.int8)
    if hand is not None:
        hidden[140:165, slice(*hand)] = apart[0]
    found = Labels(labels.astype(np.int8), none, apart, none, hidden)
    shown = (labels == apart[0]) & shows
    picture, surfaces = PictureOnGrid(rgb, alpha, SAME), LimbSurfaces(reach, shown, along)
    return paint_tiles(picture, found, surfaces, np.float32(face), back), labels  # type: ignore[arg-type]


def test_behind_an_arm_a_dress_goes_on_and_nothing_else() -> None:
    tiles, labels = painted()
    hidden = labels == BODY_PARTS.index("right_arm")
    assert np.abs(tiles.body[hidden].astype(int) - GREEN).max() <= 6, "neither arm, nor wall, nor hair"
    np.testing.assert_array_equal(tiles.limbs[hidden], person()[0][hidden])
    assert np.abs(tiles.limbs[142:163, 102:113].astype(int) - SKIN).max() <= 6, (
        "where the dress hides it an arm is an arm"
    )


def test_what_of_the_body_goes_with_an_arm_has_its_colours() -> None:
    along = np.zeros((240, 160), np.bool_)
    along[140:165, 40:60] = True
    tiles, labels = painted(along=along)
    np.testing.assert_array_equal(tiles.body[142:163, 42:57], person()[0][142:163, 42:57])
    rest = (labels == BODY_PARTS.index("right_arm")) & (np.arange(160) > 65)
    assert np.abs(tiles.body[rest].astype(int) - GREEN).max() <= 6


def test_beside_an_arm_its_surface_has_the_arms_colours_and_not_those_behind() -> None:
    """A surface that is made on the grid may end a pixel beyond the picture's edge: above and below the arm is the dress."""
    tiles, _ = painted()
    for rows in (slice(137, 140), slice(165, 168)):
        assert np.abs(tiles.limbs[rows, 45:95].astype(int) - SKIN).max() <= 1
        np.testing.assert_array_equal(tiles.body[rows, 45:95], person()[0][rows, 45:95])


def test_a_hand_in_a_pocket_is_of_the_faces_colour() -> None:
    tiles, labels = painted(hand=(100, 114))
    assert (tiles.limbs[140:165, 101:114] == SKIN).all()
    arm = labels == BODY_PARTS.index("right_arm")
    np.testing.assert_array_equal(tiles.limbs[arm], person()[0][arm])
    np.testing.assert_array_equal(tiles.body[140:165, 101:114], person()[0][140:165, 101:114])


def test_what_is_called_an_arm_and_shown_by_the_body_has_the_pictures_colours_there() -> None:
    tiles, labels = painted(shows=False)
    np.testing.assert_array_equal(tiles.body[labels >= 0], person()[0][labels >= 0])


def test_pixels_of_the_texture_are_those_of_the_picture() -> None:
    rgb = np.random.default_rng(1).integers(0, 256, (240, 160, 3)).astype(np.uint8)
    labels = np.full((120, 80), BODY_PARTS.index("torso"), np.int8)
    none = np.zeros(labels.shape, np.bool_)
    half = np.array([[0.5, 0, -0.13], [0, 0.5, -0.31]])  # a grid of half the size, somewhere between the pixels
    found = Labels(labels, none, np.zeros(0, np.int8), none, np.full(labels.shape, -1, np.int8))
    picture = PictureOnGrid(rgb, np.ones((240, 160), np.float32), half)
    tiles = paint_tiles(picture, found, LimbSurfaces(none, none), None, "mirror")
    further = tiles.shift + (tiles.scale - 1) / 2 + tiles.scale * half[:, 2]
    np.testing.assert_allclose(further, np.rint(further), atol=1e-9)
    dx, dy = np.rint(further).astype(int)
    np.testing.assert_array_equal(tiles.body[50 + dy : 70 + dy, 50 + dx : 70 + dx], rgb[50:70, 50:70])


def test_a_face_is_not_on_the_back_and_hair_is() -> None:
    tiles, _ = painted()
    rgb = person()[0]
    middle = slice(40, 66), slice(66, 94)
    assert np.abs(tiles.back[middle].astype(int) - BROWN).max() <= 12
    np.testing.assert_array_equal(tiles.body[middle], rgb[middle])


def test_a_face_that_nobody_found_is_not_on_the_back_either() -> None:
    """It begins below the crown of a head, ends with its chin, and is as wide as the head."""
    head = person()[1] == BODY_PARTS.index("head")
    x, y, wide, high, turned = face = face_within(head)
    np.testing.assert_allclose((x, wide, y + high, y - high), (80, 38, 88, 12 + 0.3 * 76), atol=1.5)
    assert turned == 0
    tiles, _ = painted("inpaint", face=tuple(face))
    middle = slice(40, 66), slice(66, 94)
    assert np.abs(tiles.back[middle].astype(int) - BROWN).max() <= 12
    assert face_within(np.zeros_like(head)) is None


def test_front_and_back_are_one_at_the_outline_and_the_back_keeps_its_gradients() -> None:
    own = np.zeros((120, 120), np.bool_)
    own[10:110, 10:110] = True
    ramp = np.arange(120, dtype=np.uint8)[None, :, None]
    front, back = np.full((120, 120, 3), 90, np.uint8), np.broadcast_to(100 + ramp // 4, (120, 120, 3)).copy()
    nowhere = np.zeros_like(own)
    joined = joined_at_the_outline(front, back, own, nowhere, 2.0)
    np.testing.assert_array_equal(joined[10:12, 10:110], front[10:12, 10:110])
    np.testing.assert_array_equal(joined[40:80, 40:80], back[40:80, 40:80])
    steps = np.abs(np.diff(joined[60, :, 0].astype(int)))
    assert steps.max() <= 4, "no edge in between, where front and back differ by up to 38"
    head = joined_at_the_outline(front, back, own, ~nowhere, 2.0)
    np.testing.assert_array_equal(head[20:100, 20:100], back[20:100, 20:100])
    assert (joined[60, 20] != back[60, 20]).any(), "a head's back begins sooner"


def cylinder(radius: int = 20) -> tuple[Layer, np.ndarray]:
    """A standing cylinder before the picture, its axis at x = 31.5."""
    x = np.arange(64) - 31.5
    mask = np.zeros((64, 64), np.bool_)
    mask[4:60] = np.abs(x) < radius
    deep = np.sqrt(np.maximum(radius**2 - x**2, 0))[None].repeat(64, 0)
    weights = np.ones((64, 64, 1), np.float32)
    sides = [Surface(np.where(mask, sign * deep, np.nan).astype(np.float32), weights) for sign in (1, -1)]
    return Layer(mask, sides[0], sides[1]), mask


def test_the_side_of_a_cylinder_takes_colours_nearly_at_the_pace_of_its_surface() -> None:
    layer, mask = cylinder()
    mesh = stitch_front_and_back([layer], mask.astype(np.float32))
    places = places_on_the_picture(mesh, np.zeros(mask.shape, np.bool_), 0)
    np.testing.assert_array_equal(places[~mesh.rim], mesh.vertices[~mesh.rim, :2])
    middle = mesh.rim & (np.abs(mesh.vertices[:, 1] - 31.5) < 10)
    inward = np.abs(mesh.vertices[middle, 0] - 31.5) - np.abs(places[middle, 0] - 31.5)
    assert ((inward > 3 * FOLD_SHARE) & (inward <= MAX_FOLD_PIXELS * FOLD_SHARE)).all()
    edges = np.concatenate([mesh.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    level = np.abs(np.ptp(mesh.vertices[edges, 1], axis=1)) < 0.1
    steep = edges[level & (mesh.rim[edges].sum(1) == 1) & (np.abs(mesh.vertices[edges[:, 0], 1] - 31.5) < 10)]
    space = np.linalg.norm(np.diff(mesh.vertices[steep], axis=1)[:, 0], axis=1)
    shown = np.linalg.norm(np.diff(places[steep], axis=1)[:, 0], axis=1)
    flat = np.linalg.norm(np.diff(mesh.vertices[steep, :2], axis=1)[:, 0], axis=1)
    assert np.median(space / flat) > 4, "stretched, were it not folded"
    assert 0.6 < np.median(space / shown) < 2.5


def test_front_and_back_take_one_place_on_the_border_and_none_that_is_barred() -> None:
    layer, mask = cylinder()
    mesh = stitch_front_and_back([layer], mask.astype(np.float32))
    places = places_on_the_picture(mesh, np.zeros(mask.shape, np.bool_), 0)
    at = {}
    for vertex in np.flatnonzero(mesh.rim):
        key = tuple(mesh.vertices[vertex, :2])
        assert np.array_equal(at.setdefault(key, places[vertex]), places[vertex])
    barred = places_on_the_picture(mesh, np.ones(mask.shape, np.bool_), 0)
    np.testing.assert_allclose(barred, mesh.vertices[:, :2], atol=1e-9)


def test_behind_an_arm_that_hangs_a_shirt_has_no_print_and_beside_it_the_picture_s_colours() -> None:
    labels = np.full((400, 200), -1)
    labels[40:360, 40:160], labels[40:360, 40:70] = BODY_PARTS.index("torso"), BODY_PARTS.index("right_arm")
    rgb = np.random.default_rng(3).normal((30, 34, 60), 5, (400, 200, 3))
    rgb[60:340, 95:130] = np.random.default_rng(4).integers(120, 256, (280, 35, 3))  # the print
    rgb = np.clip(rgb, 0, 255).astype(np.uint8)
    arm, none = labels == BODY_PARTS.index("right_arm"), np.zeros(labels.shape, np.bool_)
    apart = np.array([BODY_PARTS.index("right_arm")], np.int8)
    found = Labels(labels.astype(np.int8), none, apart, none, np.full(labels.shape, -1, np.int8))
    picture = PictureOnGrid(rgb, (labels >= 0).astype(np.float32), SAME)
    tiles = paint_tiles(picture, found, LimbSurfaces(arm, arm), None, "mirror")
    assert tiles.body[arm].max() < 90
    np.testing.assert_array_equal(tiles.body[40:360, 70:160], rgb[40:360, 70:160])


def test_where_an_arm_comes_out_from_behind_the_body_it_is_of_what_is_near_and_no_hand() -> None:
    seen = np.full((200, 160, 3), 90, np.uint8)
    own, hole = np.zeros((2, 200, 160), np.bool_)
    own[60:160, 20:50] = True
    sleeve, skin = (40, 60, 130), (225, 180, 150)
    seen[60:130, 20:50], seen[130:160, 20:50] = sleeve, skin
    hole[40:60, 20:70] = True
    made = of_the_limbs(seen, own, hole, 1.0)
    assert np.abs(made[hole].astype(int) - sleeve).max() < 12
    np.testing.assert_array_equal(made[135:155, 25:45], seen[135:155, 25:45])


def test_a_leg_that_goes_on_under_a_skirt_is_of_its_own_colours_and_not_of_the_hand_s_beside_it() -> None:
    seen = np.full((200, 160, 3), 90, np.uint8)
    own, legs = np.zeros((2, 200, 160), np.bool_)
    leg, hand, hole = np.s_[100:190, 40:80], np.s_[60:130, 82:150], np.s_[80:100, 40:80]
    own[leg] = own[hand] = legs[leg] = legs[hole] = True
    trousers, skin = (30, 30, 35), (225, 180, 150)
    seen[leg], seen[hand] = trousers, skin
    under = np.zeros_like(own)
    under[hole] = True
    made = of_the_limbs(seen, own, under, 1.0, legs)
    assert np.abs(made[hole].astype(int) - trousers).max() < 12
    np.testing.assert_array_equal(made[85:105, 95:145], seen[85:105, 95:145])


def test_a_sleeve_that_is_hidden_but_for_its_hand_is_like_the_other_one() -> None:
    """The left arm is behind the trunk, all but its hand; the right one is before it. Neither is the colour of the trunk."""
    seen = np.full((200, 160, 3), (120, 40, 40), np.uint8)
    found = np.full((200, 160), -1, np.int8)
    left, right = (BODY_PARTS.index(f"{side}_arm") for side in ("left", "right"))
    hand, hidden, other = np.s_[130:150, 110:126], np.s_[60:130, 110:126], np.s_[60:150, 40:60]
    found[20:180, 30:130] = BODY_PARTS.index("torso")
    found[hand], found[other] = left, right
    sleeve, skin = (40, 60, 130), (225, 180, 150)
    seen[hand], seen[other] = skin, sleeve
    reach = np.isin(found, (left, right))
    reach[hidden] = True
    sleeves = {arm: np.zeros_like(reach) for arm in (left, right)}
    sleeves[left][hidden], sleeves[right][other] = True, True
    labels = Labels(
        found, np.zeros_like(reach), np.array([left, right], np.int8), np.zeros_like(reach), np.full_like(found, -1)
    )
    limbs = np.isin(found, (left, right))
    everything = np.ones_like(reach)
    made = paint_limbs(seen, everything, limbs, labels, LimbSurfaces(reach, limbs, sleeves=sleeves), None, 1.0)
    assert np.abs(made[62:120, 111:125].astype(int) - sleeve).max() < 12
    np.testing.assert_array_equal(made[133:147, 113:123], seen[133:147, 113:123])
    np.testing.assert_array_equal(made[65:145, 43:57], seen[65:145, 43:57])
    rest = np.zeros_like(reach)
    rest[60:90, 110:126] = True
    seen[90:130, 110:126], found[90:130, 110:126] = (40, 130, 60), left
    most = limbs | (reach & ~rest)
    kept = paint_limbs(seen, everything, most, labels, LimbSurfaces(reach, most, sleeves=sleeves), None, 1.0)
    assert np.abs(kept[62:88, 111:125].astype(int) - (40, 130, 60)).max() < 12, "of what more is seen, like itself"
    np.testing.assert_array_equal(kept[2:18, 2:18], seen[2:18, 2:18], "and what is far from limbs stays")


def test_behind_hair_that_falls_over_a_shoulder_is_the_cloth_beside_it() -> None:
    rgb, found = person()
    hair = np.zeros(found.shape, np.bool_)
    hair[90:150, 80:105] = True
    rgb[hair], found[hair] = BROWN, -1
    held = np.where(hair, BODY_PARTS.index("head"), -1).astype(np.int8)
    none = np.zeros(hair.shape, np.bool_)
    arm = np.array([BODY_PARTS.index("right_arm")], np.int8)
    labels = Labels(found.astype(np.int8), none, arm, none, np.full(hair.shape, -1, np.int8), held=held)
    alpha = ((found >= 0) | hair).astype(np.float32)
    body = none.copy()
    body[90:220, 40:120] = True
    surfaces = LimbSurfaces(none, none, body=body)
    tiles = paint_tiles(PictureOnGrid(rgb, alpha, SAME), labels, surfaces, np.float32(FACE), "see_through")
    assert np.abs(tiles.back[100:210, 50:110].astype(int) - GREEN).max() < 12
