"""Arms and the body behind them: pieces of an arm made one, and which of two surfaces lies beneath the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from engine.body.parts import PARTS
from engine.character.figure import Choice, find_figure
from engine.character.layers import (
    BENEATH,
    FOREARM,
    THIN,
    Labels,
    PosedTemplate,
    _before,
    _behind,
    _limb,
    _put_in,
    _sunk,
    build_layers,
)
from engine.character.part_surface import Surface
from engine.character.sheets import Layer
from engine.character.silhouette import cut_out
from engine.character.stages import fit_template, label
from engine.character.template_fit import load_human, pose_template
from engine.media.limits import Limits

SHAPE = (60, 120)
LEFT, RIGHT, TORSO = (PARTS.index(name) for name in ("left_arm", "right_arm", "torso"))


def rectangle(rows: tuple[int, int], columns: tuple[int, int]) -> np.ndarray:
    mask = np.zeros(SHAPE, np.bool_)
    mask[slice(*rows), slice(*columns)] = True
    return mask


def slab(mask: np.ndarray, front: float, back: float) -> Layer:
    weights = np.ones((*SHAPE, 1), np.float32)
    sides = [Surface(np.where(mask, depth, np.nan).astype(np.float32), weights) for depth in (front, back)]
    return Layer(mask, sides[0], sides[1], np.zeros(SHAPE, np.int8))


def bar(rows: tuple[int, int], columns: tuple[int, int]) -> PosedTemplate:
    """A template of one flat arm, a rectangle, clockwise on the picture as what faces the viewer is."""
    (top, bottom), (left, right) = rows, columns
    corners = np.array([[left, top, 0], [right, top, 0], [right, bottom, 0], [left, bottom, 0]], float)
    triangles = np.array([[0, 2, 1], [0, 3, 2]], np.int32)
    nothing = np.zeros((1, 3))
    return PosedTemplate(corners, corners.astype(np.float32), triangles, nothing, nothing.astype(np.float32), 100.0)


def found(labels: np.ndarray) -> Labels:
    none = np.zeros(SHAPE, np.bool_)
    return Labels(labels.astype(np.int8), none, np.array([LEFT, RIGHT], np.int8), none, np.full(SHAPE, -1, np.int8))


def limb(labels: np.ndarray, shoulder: np.ndarray) -> np.ndarray:
    template = bar((20, 30), (10, 110))
    part = np.full(template.triangles.shape, LEFT, np.intp)
    return _limb(LEFT, found(labels), labels >= 0, template, shoulder, np.isin(labels, (LEFT, RIGHT)), part)


def test_an_arm_in_one_piece_is_what_is_seen_of_it() -> None:
    own, shoulder = rectangle((20, 30), (10, 110)), rectangle((20, 30), (8, 14))
    labels = np.where(own, LEFT, -1)
    np.testing.assert_array_equal(limb(labels, shoulder), own)


def test_an_arm_torn_by_the_other_goes_on_beneath_it() -> None:
    own, across = rectangle((20, 30), (10, 110)), rectangle((0, 60), (50, 60))
    labels = np.where(own, LEFT, -1)
    labels[across] = RIGHT
    whole = limb(labels, rectangle((20, 30), (8, 14)))
    assert whole[25, 10:110].all(), "from the shoulder to the hand"
    assert not whole[:10].any() and not whole[50:].any(), "the rest of the other arm is not its own"


def test_an_arm_that_does_not_reach_its_shoulder_is_led_there_over_the_body() -> None:
    labels = np.full(SHAPE, -1)
    labels[5:55, 5:115] = TORSO
    labels[20:30, 60:110] = LEFT
    shoulder = rectangle((20, 30), (8, 14))
    whole = limb(labels, shoulder)
    assert (whole & shoulder).any()
    assert whole[25, 14:110].all()
    assert not whole[:10].any()


def inner(mask: np.ndarray) -> np.ndarray:
    """What is far enough from the border of a mask for its border not to count: there both sides meet."""
    return np.asarray(cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0)


def test_what_a_limb_shares_with_the_body_lies_beneath_its_surface() -> None:
    body, shared = slab(rectangle((5, 55), (5, 60)), 10.0, -10.0), rectangle((20, 30), (40, 60))
    arm, own = slab(rectangle((20, 30), (40, 100)), 14.0, -12.0), rectangle((20, 30), (60, 100))
    sunk = _sunk(arm, body, own)
    deep = shared & inner(body.mask)
    assert np.allclose(sunk.front.depth[deep], 10 - BENEATH) and np.allclose(sunk.back.depth[deep], BENEATH - 10)
    assert (sunk.front.depth[shared & ~deep] <= 0 - BENEATH).all(), (
        "at its border the body is no higher than its middle"
    )
    assert (sunk.front.depth[shared] > sunk.back.depth[shared]).all()
    np.testing.assert_array_equal(sunk.front.depth[own], arm.front.depth[own])
    np.testing.assert_array_equal(sunk.back.depth[own], arm.back.depth[own])


def test_an_arm_bends_to_the_pocket_that_its_hand_is_in() -> None:
    body, hidden = slab(rectangle((5, 55), (5, 115)), 10.0, -10.0), rectangle((20, 30), (15, 30))
    arm = slab(rectangle((20, 30), (15, 110)), 16.0, 12.0)
    bent = _put_in(arm, body, hidden)
    assert np.allclose(bent.front.depth[hidden], 10 - BENEATH)
    assert np.allclose((bent.front.depth - bent.back.depth)[arm.mask], 4), "as thick as it was"
    along = bent.front.depth[25, 29 : 30 + int(FOREARM)]
    assert (np.diff(along) >= 0).all() and np.diff(along).max() < 0.25
    np.testing.assert_array_equal(bent.front.depth[25, 30 + int(FOREARM) : 110], 16)
    assert _put_in(arm, body, np.zeros_like(hidden)) is arm


def test_a_limb_behind_the_body_stays_there() -> None:
    body = slab(rectangle((5, 55), (5, 60)), 10.0, 4.0)
    arm = slab(rectangle((20, 30), (40, 60)), -5.0, -9.0)
    sunk = _sunk(arm, body, np.zeros(SHAPE, np.bool_))
    np.testing.assert_array_equal(sunk.front.depth, arm.front.depth)
    np.testing.assert_array_equal(sunk.back.depth, arm.back.depth)


def test_what_an_arm_hides_lies_behind_it() -> None:
    mask, arm_mask = rectangle((5, 55), (5, 115)), rectangle((20, 30), (40, 80))
    arm = slab(arm_mask, 6.0, 2.0)
    seen = rectangle((20, 30), (40, 60))  # of the rest the body hides the arm
    body = _behind(slab(mask, 10.0, -10.0), arm, seen)
    deep = seen & inner(arm_mask)
    assert np.allclose(body.front.depth[deep], 6 - BENEATH)
    assert np.allclose(body.front.depth[seen & ~deep], 4 - BENEATH), (
        "at its border the arm is no higher than its middle"
    )
    assert np.allclose(body.front.depth[mask & ~seen], 10), "nothing else moves"
    assert np.allclose(body.back.depth[mask], -10)
    lower = _behind(slab(mask, 10.0, -10.0), slab(arm_mask, -30.0, -40.0), seen)
    assert np.allclose(lower.front.depth[seen], 20 * THIN - 10), "the body keeps some of its depth"
    raised = _before(slab(arm_mask, -10.0, -14.0), lower, seen)
    assert (raised.front.depth[seen] >= 20 * THIN - 10 + BENEATH).all(), "and what is seen is before what is not"
    assert np.allclose((raised.front.depth - raised.back.depth)[arm_mask], 4)
    far = slab(arm_mask, -30.0, -40.0)
    np.testing.assert_array_equal(_before(far, lower, seen).front.depth[arm_mask], far.front.depth[arm_mask])
    before = _behind(slab(mask, 1.0, -1.0), replace(arm), seen)
    assert np.allclose(before.front.depth[mask], 1), "an arm that is before it anyway changes nothing"


def test_a_body_does_not_go_on_before_an_arm_that_comes_out_from_behind_it() -> None:
    mask, arm_mask = rectangle((5, 55), (5, 80)), rectangle((20, 30), (40, 110))
    shown = rectangle((20, 30), (60, 110))  # from the trunk's outline on
    trunk = mask & ~rectangle((5, 55), (60, 80)) | (mask & rectangle((20, 30), (60, 80)))
    body = _behind(slab(trunk, 10.0, -10.0), slab(arm_mask, -30.0, -40.0), shown)
    assert not body.mask[:, 61:].any(), "but for a pixel, so that nothing gapes"
    np.testing.assert_array_equal(body.mask[:, :61], trunk[:, :61])


def layers_of(photo: Path, joint: str) -> tuple[list[Layer], int, int]:
    """The layers of the person in a picture, and where one of the joints is on the grid: column and row."""
    figure = find_figure(photo, Choice(), False, Limits(), lambda code, message: None)
    silhouette = cut_out(figure, None, (), Limits(), None, None, lambda code, message: None)
    fitted, human = fit_template(figure, silhouette), load_human()
    labels = label(figure, silhouette, fitted, None, (), Limits())
    posed = pose_template(fitted, silhouette.camera(fitted.camera()), human)
    x, y = np.rint(silhouette.to_grid[:, :2] @ figure.point(joint) + silhouette.to_grid[:, 2]).astype(int)
    return build_layers(silhouette.mask, labels, posed, human.rig), x, y


def test_behind_a_hand_before_the_trunk_the_trunk_goes_on(media: Callable[[str], Path]) -> None:
    """A man who holds a mug before his belly. Looked at: trunk without arms, and both arms whole."""
    (body, *arms), x, y = layers_of(media("fullbody/man_mug_arm_across.png"), "RightWrist")
    holding = [arm for arm in arms if arm.mask[y, x]]
    assert len(arms) == 2 and len(holding) == 1
    assert body.mask[y, x]
    assert holding[0].front.depth[y, x] > body.front.depth[y, x]


def test_arms_away_from_the_trunk_are_one_with_it(media: Callable[[str], Path]) -> None:
    layers, x, y = layers_of(media("fullbody/iper_apose_1.jpg"), "RightWrist")
    assert len(layers) == 1
    assert layers[0].mask[y, x]
