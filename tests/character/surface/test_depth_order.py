"""Which of two surfaces lies beneath the other: a limb's, and that of the body which it passes before or behind."""

from __future__ import annotations

import cv2
import numpy as np

from engine.character.surface.depth_order import (
    FOREARM_BEND_PIXELS,
    INSET_PIXELS,
    MIN_BODY_DEPTH_SHARE,
    body_behind,
    body_within,
    hand_beneath,
    limb_around,
    limb_before,
    limb_behind,
    overlap_beneath,
)
from engine.character.surface.front_and_back import Layer
from engine.character.surface.part_surface import Surface

SHAPE = (60, 120)


def rectangle(rows: tuple[int, int], columns: tuple[int, int]) -> np.ndarray:
    mask = np.zeros(SHAPE, np.bool_)
    mask[slice(*rows), slice(*columns)] = True
    return mask


def slab(mask: np.ndarray, front: float, back: float) -> Layer:
    weights = np.ones((*SHAPE, 1), np.float32)
    sides = [Surface(np.where(mask, depth, np.nan).astype(np.float32), weights) for depth in (front, back)]
    return Layer(mask, sides[0], sides[1])


def inner(mask: np.ndarray) -> np.ndarray:
    """What is far enough from the border of a mask for its border not to count: there both sides meet."""
    return np.asarray(cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0)


def test_what_a_limb_shares_with_the_body_lies_beneath_its_surface() -> None:
    body, shared = slab(rectangle((5, 55), (5, 60)), 10.0, -10.0), rectangle((20, 30), (40, 60))
    arm, own = slab(rectangle((20, 30), (40, 100)), 14.0, -12.0), rectangle((20, 30), (60, 100))
    sunk = overlap_beneath(arm, body, own)
    deep = shared & inner(body.mask)
    assert np.allclose(sunk.front.depth[deep], 10 - INSET_PIXELS) and np.allclose(
        sunk.back.depth[deep], INSET_PIXELS - 10
    )
    assert (sunk.front.depth[shared & ~deep] <= 0 - INSET_PIXELS).all(), (
        "at its border the body is no higher than its middle"
    )
    assert (sunk.front.depth[shared] > sunk.back.depth[shared]).all()
    np.testing.assert_array_equal(sunk.front.depth[own], arm.front.depth[own])
    np.testing.assert_array_equal(sunk.back.depth[own], arm.back.depth[own])


def test_an_arm_that_passes_behind_comes_no_further_forth_than_the_bodys_middle() -> None:
    body, shared = slab(rectangle((5, 55), (5, 60)), 10.0, -10.0), rectangle((20, 30), (40, 60))
    arm, own = slab(rectangle((20, 30), (40, 100)), 14.0, -9.0), rectangle((20, 30), (60, 100))
    sunk = overlap_beneath(arm, body, own, deep=True)
    assert np.allclose(sunk.front.depth[shared & inner(body.mask)], 0)
    assert (sunk.front.depth[shared] > sunk.back.depth[shared]).all()
    np.testing.assert_array_equal(sunk.front.depth[own], arm.front.depth[own])


def test_an_arm_bends_to_the_pocket_that_its_hand_is_in() -> None:
    body, hidden = slab(rectangle((5, 55), (5, 115)), 10.0, -10.0), rectangle((20, 30), (15, 30))
    arm = slab(rectangle((20, 30), (15, 110)), 16.0, 12.0)
    bent = hand_beneath(arm, body, hidden)
    assert np.allclose(bent.front.depth[hidden], 10 - INSET_PIXELS)
    assert np.allclose((bent.front.depth - bent.back.depth)[arm.mask], 4), "as thick as it was"
    along = bent.front.depth[25, 29 : 30 + int(FOREARM_BEND_PIXELS)]
    assert (np.diff(along) >= 0).all() and np.diff(along).max() < 0.25
    np.testing.assert_array_equal(bent.front.depth[25, 30 + int(FOREARM_BEND_PIXELS) : 110], 16)
    assert hand_beneath(arm, body, np.zeros_like(hidden)) is arm


def test_of_two_arms_that_cross_the_one_behind_is_beneath_the_other_where_that_hides_it() -> None:
    before, hidden = slab(rectangle((20, 30), (5, 80)), 12.0, 4.0), rectangle((20, 30), (40, 60))
    arm = slab(rectangle((18, 32), (40, 110)), 14.0, 8.0)
    moved = limb_behind(arm, before, hidden)
    deep = hidden & inner(before.mask)
    assert (moved.front.depth[deep] <= 12 - INSET_PIXELS + 1e-5).all()
    assert np.allclose((moved.front.depth - moved.back.depth)[arm.mask], 6), "as thick as it was"
    assert np.allclose(moved.front.depth[25, 100:110], 14), "far from it nothing moves"
    assert np.abs(np.diff(moved.front.depth[25, 62:110])).max() < 1, "it bends"


def test_where_no_body_is_behind_an_arm_reaches_around_the_hand_that_it_hides() -> None:
    before, hidden = slab(rectangle((20, 40), (5, 80)), 12.0, 4.0), rectangle((25, 35), (40, 60))
    hand, body = slab(hidden, 2.0, -3.0), slab(rectangle((10, 50), (50, 110)), 6.0, -10.0)
    around = limb_around(before, hand, body, hidden)
    assert (around.back.depth[hidden & ~body.mask] <= -3 - INSET_PIXELS + 1e-5).all()
    np.testing.assert_array_equal(around.front.depth, before.front.depth)
    assert np.allclose(around.back.depth[30, 5:12], 4, atol=0.05), "far from it it is as thick as it was"
    behind_the_body = limb_around(before, hand, slab(rectangle((10, 50), (5, 110)), 6.0, -10.0), hidden)
    assert np.allclose(behind_the_body.back.depth[before.mask], 4)


def test_a_limb_behind_the_body_stays_there() -> None:
    body = slab(rectangle((5, 55), (5, 60)), 10.0, 4.0)
    arm = slab(rectangle((20, 30), (40, 60)), -5.0, -9.0)
    sunk = overlap_beneath(arm, body, np.zeros(SHAPE, np.bool_))
    np.testing.assert_array_equal(sunk.front.depth, arm.front.depth)
    np.testing.assert_array_equal(sunk.back.depth, arm.back.depth)


def test_what_an_arm_hides_lies_behind_it() -> None:
    mask, arm_mask = rectangle((5, 55), (5, 115)), rectangle((20, 30), (40, 80))
    arm = slab(arm_mask, 6.0, 2.0)
    seen = rectangle((20, 30), (40, 60))  # of the rest the body hides the arm
    body = body_behind(slab(mask, 10.0, -10.0), arm, seen)
    deep = seen & inner(arm_mask)
    assert np.allclose(body.front.depth[deep], 6 - INSET_PIXELS)
    assert np.allclose(body.front.depth[seen & ~deep], 4 - INSET_PIXELS), (
        "at its border the arm is no higher than its middle"
    )
    assert np.allclose(body.front.depth[mask & ~seen], 10), "nothing else moves"
    assert np.allclose(body.back.depth[mask], -10)
    lower = body_behind(slab(mask, 10.0, -10.0), slab(arm_mask, -30.0, -40.0), seen)
    assert np.allclose(lower.front.depth[seen], 20 * MIN_BODY_DEPTH_SHARE - 10), "the body keeps some of its depth"
    raised = limb_before(slab(arm_mask, -10.0, -14.0), lower, seen)
    assert (raised.front.depth[seen] >= 20 * MIN_BODY_DEPTH_SHARE - 10 + INSET_PIXELS).all(), (
        "and what is seen is before what is not"
    )
    assert np.allclose((raised.front.depth - raised.back.depth)[arm_mask], 4)
    far = slab(arm_mask, -30.0, -40.0)
    np.testing.assert_array_equal(limb_before(far, lower, seen).front.depth[arm_mask], far.front.depth[arm_mask])
    before = body_behind(slab(mask, 1.0, -1.0), arm, seen)
    assert np.allclose(before.front.depth[mask], 1), "an arm that is before it anyway changes nothing"


def test_a_body_does_not_go_on_before_an_arm_that_comes_out_from_behind_it() -> None:
    mask, arm_mask = rectangle((5, 55), (5, 80)), rectangle((20, 30), (40, 110))
    shown = rectangle((20, 30), (60, 110))  # from the trunk's outline on
    trunk = mask & ~rectangle((5, 55), (60, 80)) | (mask & rectangle((20, 30), (60, 80)))
    body = body_behind(slab(trunk, 10.0, -10.0), slab(arm_mask, -30.0, -40.0), shown)
    assert not body.mask[:, 61:].any(), "but for a pixel, so that nothing gapes"
    np.testing.assert_array_equal(body.mask[:, :61], trunk[:, :61])


def test_where_both_have_the_hip_the_body_is_within_the_leg() -> None:
    mask, shared = rectangle((5, 55), (5, 80)), rectangle((20, 30), (40, 60))
    leg = slab(rectangle((20, 30), (40, 110)), 6.0, -6.0)
    body = body_within(body_behind(slab(mask, 10.0, -10.0), leg, shared), leg, shared)
    deep = shared & inner(leg.mask)
    assert np.allclose(body.front.depth[deep], 6 - INSET_PIXELS) and np.allclose(
        body.back.depth[deep], INSET_PIXELS - 6
    )
    assert np.allclose(body.back.depth[mask & ~shared], -10), "nothing else moves"
    thin = body_within(body, slab(leg.mask, 30.0, 20.0), shared)
    assert (thin.back.depth < thin.front.depth)[mask].all(), "it keeps a front and a back"
