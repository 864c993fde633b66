"""The template's own texture: an iris about a pupil, crowns and gums, nails on the backs of fingertips."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from engine.avatar.mesh import AVATAR_PARTS
from engine.avatar.registration.eyes.tucked_lids import with_tucked_lids
from engine.avatar.texture.template_surface import TemplateSurface, template_surface
from engine.avatar.texture.template_texture.eyes import Eyeballs, painted_eyes, persons_eyes
from engine.avatar.texture.template_texture.lids import place_lids
from engine.avatar.texture.template_texture.mouth import (
    LINING_IN_MOUTH_RGB,
    MIN_MOUTH_LIGHT_SHARE,
    mouth_light,
    painted_lining,
    painted_teeth,
    painted_tongue,
)
from engine.avatar.texture.template_texture.part_texels import PartTexels
from engine.body.rig import HUMAN_RIG, Rig
from engine.body.template import load_rig, load_template
from engine.performances.modelling.eyes import EYEBALL_RADIUS_METRES
from engine.performances.modelling.hands import hand_bones, painted_hand, past_wrist
from engine.render.textures.texture_bake import texel_raster


@pytest.fixture(scope="module")
def rig() -> Rig:
    return load_rig(HUMAN_RIG)


@pytest.fixture(scope="module")
def surface(rig: Rig) -> TemplateSurface:
    return template_surface(load_template(), rig)


def eyeball(count: int = 4000) -> Eyeballs:
    """Places all over a ball."""
    places = np.random.default_rng(0).normal(size=(count, 3))
    places *= EYEBALL_RADIUS_METRES / np.linalg.norm(places, axis=1, keepdims=True)
    return Eyeballs(places, np.zeros(count, np.intp), np.zeros((count, 3), np.float32))


def test_the_surface_knows_its_parts(surface: TemplateSurface) -> None:
    assert {part: int(surface.of(part).sum()) for part in AVATAR_PARTS} == {
        "body": 26756,
        "left_eye": 140,
        "right_eye": 140,
        "upper_teeth": 96,
        "lower_teeth": 96,
        "tongue": 448,
    }
    middles = surface.rest[surface.triangles].mean(1)
    assert (middles[surface.hands["Left"], 0] > 0.35).all() and (middles[surface.hands["Right"], 0] < -0.35).all()
    mouth = middles[surface.mouth]
    assert len(mouth) > 500 and (np.abs(mouth - [0, 0.66, 0.1]) < 0.06).all()
    stitched = surface.fitted(surface.rest).stitched
    assert not stitched[surface.mouth].any() and stitched[surface.hands["Left"]].all()


def test_what_lies_in_a_lid_s_fold_is_not_taken_from_frames_and_painted_like_the_skin_below(
    surface: TemplateSurface,
) -> None:
    folds = surface.lid_folds(surface.rest)
    stitched = surface.fitted(surface.rest).stitched
    for part, folded in folds.items():
        eye = surface.rest[surface.lid_rims[part]]
        middles = surface.rest[surface.triangles[folded]].mean(1)
        assert 10 < folded.sum() < 400 and np.linalg.norm(middles - eye.mean(0), axis=1).max() < 0.025
        assert not stitched[folded].any()
        at_rim = np.isin(surface.triangles, surface.lid_rims[part]).any(1)
        assert (folded | surface.sockets)[at_rim].all()  # nowhere along the rim is lid and eyeball of one pixel
    assert not stitched[surface.sockets].any()
    raster = texel_raster(surface.atlas, 1024)
    texture = np.full((1024, 1024, 3), (180, 130, 110), np.uint8)
    inside = np.any(list(folds.values()), axis=0)[raster.triangle] & (raster.triangle >= 0)
    texture[inside] = 0
    place_lids(texture, surface, surface.rest, raster)
    lids = texture[inside].astype(float) / [180, 130, 110]
    assert 0.25 < np.median(lids) <= 1 and lids.max() <= 1
    assert (texture[~inside] == (180, 130, 110)).all()


def test_of_a_lower_lid_what_looks_ahead_is_in_no_fold(surface: TemplateSurface) -> None:
    """But for what meets the rim itself: below the eye's corners nothing is narrower than lashes."""
    corners = surface.rest[surface.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    middles = corners.mean(1)
    for part, folded in surface.lid_folds(surface.rest).items():
        rim = surface.rest[surface.lid_rims[part]]
        ahead = rim.mean(0) - surface.rest[np.unique(surface.triangles[surface.of(part)])].mean(0)
        first, last = rim[rim[:, 0].argmin()], rim[rim[:, 0].argmax()]
        below = middles[:, 1] < np.interp(middles[:, 0], [first[0], last[0]], [first[1], last[1]])
        lower = folded & below & ~np.isin(surface.triangles, surface.lid_rims[part]).any(1)
        assert lower.any() and (normals[lower] @ ahead / np.linalg.norm(ahead)).max() < 0.5


@pytest.mark.parametrize("shown_above", [(150, 108, 92), (40, 30, 25)], ids=["skin", "brow"])
def test_an_upper_lid_is_skin_up_to_its_crease_and_goes_over_to_what_frames_show_above(
    surface: TemplateSurface, shown_above: tuple[int, int, int]
) -> None:
    vertices = with_tucked_lids(load_template(), surface.rest)
    folds = surface.lid_folds(vertices)
    raster = texel_raster(surface.atlas, 2048)
    light, dark = np.array([180, 130, 110]), np.array(shown_above)
    texture = np.full((2048, 2048, 3), light, np.uint8)
    eye = vertices[surface.lid_rims["left_eye"]]
    shown = PartTexels.of(raster, surface.of("body") & ~surface.sockets)
    places = shown.blend(vertices, surface.triangles)
    first, last = eye[eye[:, 0].argmin()], eye[eye[:, 0].argmax()]
    above = places[:, 1] > np.interp(places[:, 0], [first[0], last[0]], [first[1], last[1]])
    texture.reshape(-1, 3)[shown.texels[above]] = dark
    place_lids(texture, surface, vertices, raster)
    whole, partly = surface.tucked("left_eye", vertices)
    assert (folds["left_eye"] | ~whole).all()
    lids = PartTexels.of(raster, whole | partly)
    up = lids.blend(surface.lid_skin("left_eye", vertices), surface.triangles)[:, 1]
    colours = texture.reshape(-1, 3)[lids.texels]
    places = lids.blend(vertices, surface.triangles)
    across = (places[:, 0] - first[0]) / (last[0] - first[0])
    mid = np.abs(across - 0.5) < 0.2
    end, skin, rim = mid & (up > 0.95) & (up < 1.1), mid & (up > 0.3) & (up < 0.4), mid & (up < 0.05)
    assert min(end.sum(), skin.sum(), rim.sum()) > 3
    np.testing.assert_allclose(colours[end].mean(0), dark, atol=25)
    share = colours[skin].mean(0) / light
    assert share.min() > 0.7 and np.ptp(share) < 0.04, "no brow is drawn out over a lid"
    assert colours[rim].mean() < 0.75 * colours[skin].mean(), "lashes"
    columns = np.isin(surface.triangles, surface.lid_columns["left_eye"]).all(1)
    hidden = PartTexels.of(raster, folds["left_eye"] & columns & ~whole & ~partly)
    beyond = hidden.blend(surface.lid_skin("left_eye", vertices), surface.triangles)[:, 1] > 1.05
    assert beyond.sum() > 10
    np.testing.assert_allclose(
        texture.reshape(-1, 3)[hidden.texels[beyond]], dark + np.zeros((beyond.sum(), 1)), atol=12
    )


def test_a_shut_lid_has_a_crease_at_its_fold(surface: TemplateSurface) -> None:
    """Which is darker than the lid below it, and than all around, where all skin has one colour."""
    vertices = with_tucked_lids(load_template(), surface.rest)
    raster = texel_raster(surface.atlas, 2048)
    texture = np.full((2048, 2048, 3), (180, 130, 110), np.uint8)
    place_lids(texture, surface, vertices, raster)
    lids = PartTexels.of(raster, surface.tucked("left_eye", vertices)[0])
    up = lids.blend(surface.lid_skin("left_eye", vertices), surface.triangles)[:, 1]
    x = lids.blend(vertices, surface.triangles)[:, 0]
    rim = vertices[surface.lid_rims["left_eye"], 0]
    mid = np.abs(x - rim.mean()) < 0.2 * np.ptp(rim)
    light = texture.reshape(-1, 3)[lids.texels].mean(1) / 140
    crease, lid = light[mid & (up > 0.7) & (up < 0.85)], light[mid & (up > 0.4) & (up < 0.5)]
    assert len(crease) > 3 and len(lid) > 3
    assert crease.mean() < lid.mean() - 0.03 and lid.mean() > 0.95


def test_what_a_hand_lies_on_is_not_taken_from_frames(surface: TemplateSurface) -> None:
    hand = np.unique(surface.triangles[surface.hands["Left"]])
    posed = surface.rest.copy()
    middles = surface.rest[surface.triangles].mean(1)
    thigh = np.array([0.2, -0.25, 0.05])
    posed[hand] += thigh - posed[hand].mean(0)
    lost = surface.fitted(surface.rest).stitched & ~surface.fitted(posed).stitched
    assert lost.any() and not lost[surface.hands["Left"] | surface.hands["Right"]].any()
    assert (np.linalg.norm(middles[lost] - thigh, axis=1) < 0.15).all()
    near = np.linalg.norm(middles[:, None] - posed[hand][None, ::20], axis=2).min(1) < 0.01
    assert lost[near & (middles[:, 1] < 0)].all()
    doubted = surface.fitted(posed).doubted
    assert doubted is not None and doubted[lost].all() and doubted.sum() > 1.3 * lost.sum(), "farther around a hand"
    assert not doubted[surface.hands["Left"] | surface.hands["Right"]].any()


def test_an_eye_is_black_then_coloured_then_white() -> None:
    eyes = eyeball()
    lightness, off = painted_eyes(eyes).mean(1), eyes.off_axis
    pupil, iris, white = off < 0.0015, (off > 0.0028) & (off < 0.0045), off > 0.007
    assert lightness[pupil].max() < 40 < lightness[iris].mean() < 120 < lightness[white].min()


def test_a_persons_eyes_have_their_colours_and_keep_the_pupil() -> None:
    eyes = eyeball()
    painted = painted_eyes(eyes)
    random = np.random.default_rng(1)
    blue, white = random.normal((90, 120, 170), 6, (200, 3)), random.normal((190, 185, 180), 4, (200, 3))
    found, off = persons_eyes(painted, eyes, blue, white), eyes.off_axis
    np.testing.assert_array_equal(found[off < 0.002], painted[off < 0.002])
    np.testing.assert_allclose(found[(off > 0.0027) & (off < 0.0054)].mean(0), (90, 120, 170), atol=6)
    np.testing.assert_allclose(found[off > 0.0058].mean(0), (190, 185, 180), atol=3)
    np.testing.assert_array_equal(persons_eyes(painted, eyes, blue[:5], white[:5]), painted)


@pytest.mark.parametrize("iris", [0.0052, 0.0068])
def test_an_iris_is_as_large_as_it_was_measured(iris: float) -> None:
    places = 0.013 * eyeball().places / EYEBALL_RADIUS_METRES
    eyes = Eyeballs.of(places, 0.013, iris, np.zeros(len(places), np.intp), np.zeros((len(places), 3), np.float32))
    off, ahead = np.hypot(places[:, 0], places[:, 1]), places[:, 2] > 0
    lightness = painted_eyes(eyes).mean(1)
    assert lightness[ahead & (off < iris - 0.0008)].max() < 130
    assert lightness[ahead & (off > iris + 0.0012)].min() > 140
    np.testing.assert_allclose(np.linalg.norm(eyes.places, axis=1), EYEBALL_RADIUS_METRES)


def test_teeth_are_light_at_their_edges_and_gum_at_their_roots(surface: TemplateSurface) -> None:
    for part, upper in (("upper_teeth", True), ("lower_teeth", False)):
        places = surface.rest[surface.triangles[surface.of(part)]].mean(1)
        colours = painted_teeth(places, upper)
        height = (places[:, 1] - places[:, 1].min()) / np.ptp(places[:, 1])
        at_edge = height < 0.3 if upper else height > 0.7
        at_root = height > 0.85 if upper else height < 0.15
        assert at_edge.any() and at_root.any()
        assert colours[at_edge].mean(1).min() > 105
        assert (colours[at_root, 0] > 1.5 * colours[at_root, 1]).all()


def test_the_mouth_is_red_and_darkens_inwards(surface: TemplateSurface) -> None:
    for part, paint in ((surface.of("tongue"), painted_tongue), (surface.mouth, painted_lining)):
        places = surface.rest[surface.triangles[part]].mean(1)
        colours = paint(places)
        assert (colours[:, 0] > colours[:, 1]).all()
        front, back = places[:, 2] > np.quantile(places[:, 2], 0.8), places[:, 2] < np.quantile(places[:, 2], 0.2)
        assert colours[front].mean() > 1.4 * colours[back].mean()


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_nails_lie_on_the_backs_of_fingertips(surface: TemplateSurface, rig: Rig, side: str) -> None:
    bones = hand_bones(rig, surface.rest, "Left" if side == "Left" else "Right")
    assert len(bones.phalanges) == 15
    tips = [bone for bone in bones.phalanges if bone.number == 3]
    middles = np.stack([bone.start + 0.75 * (bone.end - bone.start) for bone in tips])
    backs = np.stack([bone.back for bone in tips])

    def redness(places: NDArray, normals: NDArray) -> NDArray:
        colours = painted_hand(bones, places, normals)
        return np.asarray(colours[:, 0] - colours[:, 1])

    beside = np.concatenate([middles + 0.004 * backs, middles - 0.004 * backs])
    found = redness(beside, np.concatenate([backs, -backs]))
    assert (found[:5] < found[5:] - 4).all()


def test_backs_of_hands_look_up_and_out_as_the_arms_hang(surface: TemplateSurface, rig: Rig) -> None:
    left, right = (hand_bones(rig, surface.rest, side) for side in ("Left", "Right"))
    np.testing.assert_allclose(left.back * [-1, 1, 1], right.back, atol=1e-3)
    hand = surface.rest[surface.triangles[surface.hands["Left"]]].mean(1)
    assert (past_wrist(left, hand, 0.03) == 1).mean() > 0.8
    elbow = rig.joints(surface.rest)[0][rig.index("LeftForeArm")]
    assert past_wrist(left, elbow[None], 0.03) == 0


def test_fine_texels_are_the_same_texels_more_often(surface: TemplateSurface) -> None:
    raster = texel_raster(surface.atlas, 1024)
    part = surface.of("left_eye")
    coarse, fine = PartTexels.of(raster, part), PartTexels.fine(surface.atlas, part, 1024)
    assert np.isin(coarse.texels, fine.texels).all()
    inner = coarse.texels[np.isin(coarse.texels + 1, coarse.texels) & np.isin(coarse.texels - 1, coarse.texels)]
    places = [each.blend(surface.rest, surface.triangles) for each in (coarse, fine)]
    for texel in inner[:: len(inner) // 20]:
        mean = places[1][fine.texels == texel].mean(0)
        np.testing.assert_allclose(mean, places[0][coarse.texels == texel][0], atol=5e-4)
    texture = np.zeros((1024, 1024, 3), np.uint8)
    fine.put(texture, np.full((len(fine.texels), 3), 77.0))
    assert (texture.reshape(-1, 3)[coarse.texels] == 77).all() and (texture == 77).any(2).sum() < 1.4 * len(
        coarse.texels
    )


def test_what_is_deeper_in_the_mouth_is_darker() -> None:
    places = np.zeros((40, 3))
    places[:, 2] = np.linspace(0.0, -0.08, 40)
    light = mouth_light(places)
    assert light[0] == pytest.approx(1)
    assert (np.diff(light, axis=0) < 0).all()
    assert light[-1, 0] == pytest.approx(MIN_MOUTH_LIGHT_SHARE, abs=0.02)
    assert not len(mouth_light(places[:0]))


def test_teeth_at_the_back_of_a_mouth_are_reddish() -> None:
    """The deepest is lit by what its lining sends back."""
    places = np.array([[0, 0, 0], [0, 0, -1.0]])
    light = mouth_light(places)
    np.testing.assert_allclose(light[1] / light[1, 0], LINING_IN_MOUTH_RGB / LINING_IN_MOUTH_RGB[0], rtol=1e-3)
