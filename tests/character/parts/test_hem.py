"""Legs that come out from under a skirt: found by their colours, made as surfaces of their own that go on under it."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human
from engine.character.parts.free_cloth import FreeCloth, Ring
from engine.character.parts.hem import legs_below, with_cloth
from engine.character.parts.label_map import LabelHints, Labels, label_parts
from engine.character.parts.unseen_limbs import not_seen
from engine.character.surface.drape import drape
from engine.character.surface.front_and_back import Layer, stitch_front_and_back
from engine.character.surface.layers import build_layers
from engine.character.surface.legs_beneath import leg_under_cloth
from engine.character.surface.part_surface import Surface
from engine.geometry.mesh.welding import is_closed
from tests.character.parts.test_overlapping_legs import AT_THE_SHINS, SIZE, standing

TORSO, LEFT, RIGHT = (BODY_PARTS.index(name) for name in ("torso", "left_leg", "right_leg"))
GREEN, SKIN, GREY = (40, 120, 60), (225, 180, 150), (140, 140, 145)
END = 100
"""The last row in which the cloth of `pictured` surely goes round both legs."""


def pictured(skin: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray, FreeCloth]:
    """A skirt over two legs, whose hem hangs from row 94 at the viewer's left to row 106 at the right: a picture, its labels, where
    legs are, and the cloth as it is known row by row."""
    y, x = np.mgrid[:200, :120]
    hem = 94 + (x - 30) / 5
    skirted = (y >= 20) & (y < hem) & (abs(x - 60) < 34)
    legs = (y >= hem) & (y < 190) & ((abs(x - 46) < 9) | (abs(x - 74) < 9))
    rgb = np.random.default_rng(5).normal(GREY, 3, (200, 120, 3))
    for where, colour in ((skirted, GREEN), (legs, skin)):
        rgb[where] = np.random.default_rng(6).normal(colour, 5, (int(where.sum()), 3))
    labels = np.full((200, 120), -1, np.int8)
    labels[skirted | legs] = np.where(x < 60, RIGHT, LEFT)[skirted | legs]
    labels[20:60][labels[20:60] >= 0] = TORSO
    rings = tuple(Ring(row, 27, 93, 0.0, 23.0, 1.0, (74.0, 46.0)) for row in range(60, END + 1))
    cloth = FreeCloth(skirted | legs, rings, 5, True, False, np.zeros_like(legs), 2.4)
    return np.clip(rgb, 0, 255).astype(np.uint8), labels, legs, cloth


def test_legs_begin_where_colours_change() -> None:
    rgb, labels, legs, cloth = pictured(SKIN)
    found = legs_below(rgb, labels, cloth)
    assert ((found >= 0) ^ legs).sum() < 0.01 * legs.sum()
    assert (found[legs & (labels == LEFT)] == LEFT).mean() > 0.99
    assert (found[legs & (labels == RIGHT)] == RIGHT).mean() > 0.99


def test_legs_of_the_cloths_colours_begin_where_it_parts() -> None:
    rgb, labels, _, cloth = pictured(GREEN)
    found = legs_below(rgb, labels, cloth) >= 0
    top = found.argmax(0)[found.any(0)]
    assert top.min() >= END - 2 and top.max() <= END + 5


def test_cloth_that_hangs_beside_a_leg_as_a_thread_is_the_legs_edge() -> None:
    rgb, labels, legs, cloth = pictured(SKIN)
    beside = np.zeros_like(legs)
    beside[104:118, 55:57] = True
    labels[beside] = RIGHT
    cloth = replace(cloth, worn=cloth.worn | beside, lower=beside)
    assert (legs_below(rgb, labels, cloth)[beside] == RIGHT).mean() > 0.9


def test_taken_apart_a_skirt_is_the_trunks_and_the_map_stays() -> None:
    rgb, labels, legs, cloth = pictured(SKIN)
    none = np.zeros(labels.shape, np.bool_)
    whole = Labels(labels, none, np.zeros(0, np.int8), legs, np.full(labels.shape, -1, np.int8))
    assert whole.layered is whole
    found = legs_below(rgb, labels, cloth)
    apart = replace(whole, cloth=replace(cloth, legs=found)).layered
    assert set(apart.apart) == {LEFT, RIGHT} and not apart.parting.any()
    assert (apart.labels[(labels >= 0) & (found < 0)] == TORSO).all()
    np.testing.assert_array_equal(apart.labels[found >= 0], found[found >= 0])


@pytest.fixture(scope="module")
def dressed() -> tuple[PosedTemplate, Labels, np.ndarray, int]:
    """The template in a green skirt that ends between knees and feet: what it is, its labels, its mask and the hem's row."""
    human, template = load_human(), standing({"LeftUpLeg": (0, 0, 6), "RightUpLeg": (0, 0, -6)})
    mask = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    hips, knees = (int(template.joints[human.rig.index(name), 1]) for name in ("LeftUpLeg", "LeftLeg"))
    hem = knees + 25
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    middle = float(template.joints[human.rig.index("Hips"), 0])
    skirted = (y >= hips - 30) & (y < hem) & (abs(x - middle) < 34 + (y - hips) / 2.5)
    rgb = np.where(skirted[..., None], GREEN, np.where(mask[..., None], SKIN, GREY)).astype(np.uint8)
    labels = with_cloth(label_parts(rgb, mask | skirted, template, human.rig), rgb, template, human.rig)
    return template, labels, mask | skirted, hem


def test_legs_go_on_under_a_skirt(dressed: tuple[PosedTemplate, Labels, np.ndarray, int]) -> None:
    template, labels, mask, hem = dressed
    human = load_human()
    assert labels.cloth is not None and labels.cloth.parted
    body, *legs = build_layers(labels.layered, template, human.rig)
    assert sorted(leg.limb for leg in legs if leg.limb in (LEFT, RIGHT)) == [LEFT, RIGHT]
    assert not body.mask[hem + 3 :, SIZE[1] // 2 - 60 : SIZE[1] // 2 + 60].any(), "the skirt ends"
    covered = body.mask.copy()
    for leg in (leg for leg in legs if leg.limb in (LEFT, RIGHT)):
        covered |= leg.mask
        rows = np.flatnonzero(leg.mask.any(1))
        assert hem - 40 < rows[0] < hem - 15 and rows[-1] > SIZE[0] * 0.8, "from under it to the sole"
        under = leg.mask & body.mask
        under[hem - 4 :] = False
        assert under.sum() > 200
        assert (leg.front.depth < body.front.depth)[under].all() and (leg.back.depth > body.back.depth)[under].all()
        own = [k for k, name in enumerate(human.rig.names) if name.startswith("Left" if leg.limb == LEFT else "Right")]
        assert leg.front.weights[hem + 8 :][leg.mask[hem + 8 :]][:, own].sum(1).min() > 0.99
        at = int(rows[0]), int(np.flatnonzero(leg.mask[rows[0]]).mean())
        np.testing.assert_allclose(leg.front.weights[at], body.front.weights[at], atol=0.02)
    assert (covered | ~mask).mean() > 0.999, "nothing of the person is lost"


def test_a_hem_is_open_from_beneath(dressed: tuple[PosedTemplate, Labels, np.ndarray, int]) -> None:
    template, labels, mask, hem = dressed
    layers = build_layers(labels.layered, template, load_human().rig)
    mesh = stitch_front_and_back(layers, mask.astype(np.float32))
    _, point = np.unique(np.round(mesh.vertices, 6), axis=0, return_inverse=True)
    assert is_closed(point.ravel()[mesh.triangles])
    x, y = SIZE[1] // 2, hem - 1
    near = (mesh.layer == 0) & (abs(mesh.vertices[:, 0] - x) < 1) & (abs(mesh.vertices[:, 1] - y) < 2)
    deep = layers[0].front.depth[y - 4, x] - layers[0].back.depth[y - 4, x]
    assert np.ptp(mesh.vertices[near, 2]) > 0.8 * deep, "front and back end apart"
    assert not mesh.rim[near].any(), "and have their own colours, not those further in"
    inside = (mesh.layer == 0) & (abs(mesh.vertices[:, 0] - x) < 1)
    depth = abs(mesh.vertices[inside, 2] - layers[0].front.depth[y - 4, x] + deep / 2)
    assert depth.min() < 0.2 * deep, "and are joined between them"
    assert mesh.vertices[inside][depth.argmin(), 1] < y - 8, "further up"


def test_what_is_no_skirt_is_not_open_from_beneath() -> None:
    human, template = load_human(), standing({})
    mask = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    rgb = np.where(mask[..., None], SKIN, GREY).astype(np.uint8)
    labels = with_cloth(label_parts(rgb, mask, template, human.rig), rgb, template, human.rig)
    assert labels.layered is labels
    body = build_layers(labels, template, human.rig)[0]
    assert body.hem is None or not body.hem.any()


def test_an_outline_that_leans_inward_is_no_hem() -> None:
    """What lies inside a hem lies within the cloth."""
    mask = cv2.fillPoly(np.zeros((120, 120), np.uint8), [np.array([[50, 20], [70, 20], [110, 90], [10, 90]])], (1,)) > 0
    rings = tuple(
        Ring(row, int(np.flatnonzero(mask[row])[0]), int(np.flatnonzero(mask[row])[-1]), 0.0, 20.0, 1.0, (70.0, 50.0))
        for row in range(30, 91)
    )
    flat = Surface(np.where(mask, 0, np.nan).astype(np.float32), np.zeros((120, 120, 1), np.float32))
    hem = drape(Layer(mask, flat, flat), FreeCloth(mask, rings, 5, True, False, np.zeros_like(mask), 2.0)).hem
    assert hem is not None
    ys, xs = np.nonzero(hem)
    assert len(ys) > 50 and (ys == 90).all()
    for y, x in zip(ys, xs, strict=True):
        assert mask[y - int(hem[y, x]) : y, x].all()


def test_under_cloth_a_leg_goes_on_beside_the_other_and_not_over_it() -> None:
    """The hem slants, so that the other leg, which touches this one, has come out where this one has not."""
    own, other, cloth, bone = np.zeros((4, 120, 80), np.bool_)
    cloth[10:60, 5:75] = True
    own[60:110, 32:46] = other[46:110, 18:32] = True
    cloth &= ~other
    bone[0:58, 22:44] = bone[58:110, 28:50] = True
    under = leg_under_cloth(own, cloth, bone, 20)
    assert under[45:60, 32:38].all() and not (under & other).any()
    rows = np.flatnonzero(under.any(1))
    assert rows[0] == 40 and rows[-1] == 59
    width = under.sum(1)[rows]
    assert width[0] < 0.75 * width[-1], "narrower at its end"


def in_green(template: PosedTemplate) -> tuple[np.ndarray, np.ndarray, int]:
    """The template in a green skirt to its knees: a picture, the person's outline and the hem's row."""
    rig = load_human().rig
    mask = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    hips, knees = (int(template.joints[rig.index(name), 1]) for name in ("LeftUpLeg", "LeftLeg"))
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    middle = float(template.joints[rig.index("Hips"), 0])
    skirted = (y >= hips - 30) & (y < knees + 5) & (abs(x - middle) < 34 + (y - hips) / 2.5)
    rgb = np.where(skirted[..., None], GREEN, np.where(mask[..., None], SKIN, GREY)).astype(np.uint8)
    return rgb, mask | skirted, knees + 5


def in_a_skirt(turns: dict[str, tuple[int, int, int]]) -> tuple[PosedTemplate, Labels, int]:
    """The template so posed, in that skirt: what it is, its labels and the hem's row."""
    template, rig = standing(turns), load_human().rig
    rgb, mask, hem = in_green(template)
    return template, with_cloth(label_parts(rgb, mask, template, rig), rgb, template, rig), hem


@pytest.mark.parametrize(
    ("turns", "before"), [(AT_THE_SHINS, RIGHT), ({"Hips": (0, 90, 0)}, RIGHT)], ids=["cross", "side"]
)
def test_beneath_a_skirt_the_leg_behind_goes_on_where_the_other_hides_it(
    turns: dict[str, tuple[int, int, int]], before: int
) -> None:
    template, labels, hem = in_a_skirt(turns)
    behind = LEFT + RIGHT - before
    assert labels.cloth is not None and labels.cloth.before == before
    layers = {layer.limb: layer for layer in build_layers(labels.layered, template, load_human().rig)}
    own = [template.covers((vertex_parts(load_human().rig)[template.triangles] == leg).all(1), SIZE)
           for leg in (behind, before)]  # fmt: skip
    hidden = own[0] & own[1]
    hidden[: hem + 2] = False
    assert hidden.sum() > 250
    leg, other = layers[behind], layers[before]
    assert (leg.mask & hidden).sum() > 0.95 * hidden.sum()
    assert not (layers[-1].mask & own[0])[hem + 4 :].any(), "none of it is the skirt's"
    both = leg.mask & other.mask & (labels.layered.labels == before)
    assert (leg.front.depth < other.front.depth)[both].all()
    part = vertex_parts(load_human().rig)
    forth = template.vertices + np.outer(part == behind, [0, 0, 80])  # had the fit the legs the other way round
    for wrong in build_layers(labels.layered, replace(template, vertices=forth), load_human().rig):
        if wrong.limb == behind:
            shown = wrong.mask & other.mask & (labels.layered.labels == before)
            assert (wrong.front.depth < other.front.depth)[shown].all()
    own_joints = [name.startswith("Left" if behind == LEFT else "Right") for name in load_human().rig.names]
    weight = np.nanmean(np.where(leg.mask, leg.front.weights[..., own_joints].sum(-1), np.nan)[hem - 8 : hem + 8], 1)
    assert abs(np.diff(weight)).max() < 0.1, "it goes over into the cloth evenly"
    rows = np.flatnonzero(leg.mask.any(1))
    assert rows[0] < hem - 10 and rows[-1] > SIZE[0] * 0.8, "from under it to the sole"


def test_a_leg_that_is_not_labelled_is_under_the_skirt_and_not_made_up() -> None:
    human, template = load_human(), standing({"Hips": (0, 90, 0)})
    rgb, mask, hem = in_green(template)
    found = label_parts(rgb, mask, template, human.rig).labels
    given = np.where(found == LEFT, RIGHT, found).astype(np.int8)
    labels = with_cloth(label_parts(rgb, mask, template, human.rig, LabelHints(given)), rgb, template, human.rig)
    assert labels.cloth is not None and labels.cloth.hangs and abs(labels.cloth.rings[-1].row - hem) < 12
    assert LEFT not in not_seen(labels)


@pytest.mark.parametrize(("turn", "wider"), [(85, 7), (100, 5)])
def test_trousers_from_the_side_are_no_skirt(turn: int, wider: int) -> None:
    human, template = load_human(), standing({"Hips": (0, turn, 0)})
    covered = template.covers(np.ones(len(template.triangles), np.bool_), SIZE)
    mask = cv2.dilate(covered.astype(np.uint8), np.ones((3, 3), np.uint8), iterations=wider) > 0
    rgb = np.where(mask[..., None], GREEN, GREY).astype(np.uint8)
    labels = with_cloth(label_parts(rgb, mask, template, human.rig), rgb, template, human.rig)
    assert labels.cloth is None or not labels.cloth.hangs


def test_a_skirt_goes_round_legs_that_stride_to_the_side() -> None:
    """Where one leg hides the other, both are there."""
    _, labels, hem = in_a_skirt({"Hips": (0, -60, 0), "LeftUpLeg": (-20, 0, 0), "RightUpLeg": (14, 0, 0)})
    assert labels.cloth is not None and labels.cloth.parted
    assert abs(labels.cloth.rings[-1].row - hem) < 12
