"""What hands hold, told from cloth that hangs beside them. The template stands for the person."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS, vertex_parts
from engine.character.fit.posed_template import PosedTemplate
from engine.character.fit.template_fit import load_human
from engine.character.fit.template_maps import side_maps
from engine.character.parts.held_things import held_things
from engine.character.parts.label_map import label_parts
from engine.character.parts.pockets import template_hand
from engine.imaging.masks.mask_distance import distance_inside, distance_to
from tests.character.parts.test_overlapping_legs import SIZE, standing

LEFT, TORSO = BODY_PARTS.index("left_arm"), BODY_PARTS.index("torso")
SHIRT, SKIN, ORANGE, WALL = (60, 60, 160), (200, 150, 125), (230, 120, 30), (200, 200, 200)
BALL_RADIUS = 20


@pytest.fixture(scope="module")
def template() -> PosedTemplate:
    return standing({})


@pytest.fixture(scope="module")
def body(template: PosedTemplate) -> NDArray[np.bool_]:
    return side_maps(template.vertices, template.triangles, SIZE, "front").mask


@pytest.fixture(scope="module")
def hand(template: PosedTemplate) -> NDArray[np.bool_]:
    return template_hand(template.vertices, template.triangles, load_human().rig, LEFT, SIZE)


@pytest.fixture(scope="module")
def ball(hand: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Below the left hand, which is before it."""
    y, x = np.nonzero(hand)
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    return np.hypot(columns - x[y == y.max()].mean(), rows - y.max() - 0.6 * BALL_RADIUS) < BALL_RADIUS


def picture(
    template: PosedTemplate, *painted: tuple[NDArray[np.bool_], tuple[int, int, int]]
) -> tuple[NDArray[np.uint8], NDArray[np.int8]]:
    """Skin and shirt of a template with areas `painted` over it, a little noisy, and which part each pixel shows."""
    seen = side_maps(template.vertices, template.triangles, SIZE, "front")
    part = vertex_parts(load_human().rig)[template.triangles[:, 0]]
    labels = np.where(seen.mask, part[seen.raster.triangle], -1)
    rgb = np.where(np.isin(labels, (LEFT, LEFT + 1))[..., None], SKIN, np.where(seen.mask[..., None], SHIRT, WALL))
    for area, colour in painted:
        rgb = np.where(area[..., None], colour, rgb)
        labels = np.where(area & (labels < 0), TORSO, labels)
    noisy = rgb + np.random.default_rng(1).normal(0, 4, rgb.shape)
    return np.clip(noisy, 0, 255).astype(np.uint8), labels.astype(np.int8)


def overlap(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> float:
    return float((one & other).sum() / (one | other).sum())


def test_a_ball_is_whole_and_in_the_hand_beside_it(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_], ball: NDArray[np.bool_]
) -> None:
    rgb, labels = picture(template, (ball & ~hand, ORANGE))
    held = held_things(rgb, labels, template, load_human().rig)
    assert set(np.unique(held)) == {-1, LEFT}
    assert overlap(held == LEFT, ball & ~hand) > 0.93


def test_the_label_map_gives_it_to_the_arm_and_the_bare_one_to_nobody(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_], ball: NDArray[np.bool_]
) -> None:
    rgb, _ = picture(template, (ball & ~hand, ORANGE))
    found = label_parts(rgb, body | ball, template, load_human().rig)
    assert found.held is not None and overlap(found.held == LEFT, ball & ~hand) > 0.93
    assert (found.labels[found.held == LEFT] == LEFT).all()
    assert (found.bare.labels[found.held == LEFT] == -1).all()
    assert (found.bare.labels == found.labels)[found.held < 0].all()

    def all_torso(labels: NDArray[np.int8]) -> NDArray[np.int8]:
        return np.where(labels == LEFT, TORSO, labels).astype(np.int8)

    painted = label_parts(rgb, body | ball, template, load_human().rig, corrected=all_torso)
    assert painted.held is None, "whoever paints there has seen what is there"
    assert painted.bare is painted


def test_cloth_that_hangs_beside_the_hand_is_not_held(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_]
) -> None:
    """A coat's tail of its own colour, along trunk and leg to the hand's height and below."""
    y, x = np.nonzero(hand)
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    middle = int(np.nonzero(body[y.mean().astype(int)])[0].mean())
    tail = (rows > y.min() - 60) & (rows < y.max() + 50) & (columns > middle + 12) & (columns < x.min())
    assert (cv2.dilate(hand.astype(np.uint8), np.ones((15, 15))) > 0)[tail].any()
    for colour in (SHIRT, ORANGE):
        rgb, labels = picture(template, (tail, colour))
        assert (held_things(rgb, labels, template, load_human().rig) < 0).all()


@pytest.mark.parametrize(("gap", "is_held"), [(0, False), (6, True)], ids=["along the body", "beside it"])
def test_a_strip_that_meets_the_body_along_its_side_hangs_from_it(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_], gap: int, is_held: bool
) -> None:
    """Of a colour that nothing else has, as high as a forearm, between hand and leg."""
    y, x = np.nonzero(hand)
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    side = np.where(body & (columns < x.min() - 10), columns, -1).max(1)[:, None]
    strip = (rows > y.min() - 20) & (rows < y.max() + 50) & (columns > side + gap) & (columns < x.min() - 2) & ~body
    rgb, labels = picture(template, (strip, ORANGE))
    held = held_things(rgb, labels, template, load_human().rig) == LEFT
    assert overlap(held, strip) > 0.95 if is_held else not held.any()


def test_a_thing_of_the_skins_colour_does_not_take_the_forearm_with_it(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_]
) -> None:
    y, x = np.nonzero(hand)
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    radius = 36
    drum = (np.hypot(columns - x[y == y.max()].mean(), rows - y.max() - 0.6 * radius) < radius) & ~hand
    rgb, labels = picture(template, (drum, SKIN))
    held = held_things(rgb, labels, template, load_human().rig) == LEFT
    assert held[drum].mean() > 0.95
    forearm = (labels == LEFT) & (distance_inside(body) > 5) & (distance_to(hand) > 8)
    assert forearm.sum() > 500 and not held[forearm].any()


def test_what_lies_beside_a_shin_is_in_no_hand(
    template: PosedTemplate, body: NDArray[np.bool_], hand: NDArray[np.bool_]
) -> None:
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    middle = np.nonzero(hand)[0].max() + 4 * BALL_RADIUS
    shin = int(np.flatnonzero(body[middle]).max())
    ball = np.hypot(columns - shin - BALL_RADIUS - 6, rows - middle) < BALL_RADIUS
    rgb, labels = picture(template, (ball, ORANGE))
    assert (held_things(rgb, labels, template, load_human().rig) < 0).all()


def test_who_holds_nothing_holds_nothing(template: PosedTemplate, body: NDArray[np.bool_]) -> None:
    wide = cv2.dilate(body.astype(np.uint8), np.ones((9, 9), np.uint8)) > 0
    rgb, labels = picture(template, (wide & ~body, SHIRT))
    assert (held_things(rgb, labels, template, load_human().rig) < 0).all()
