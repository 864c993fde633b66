"""Pieces of a limb made one, where another hides some of it."""

from __future__ import annotations

import numpy as np

from engine.body.parts import BODY_PARTS
from engine.character.fit.posed_template import PosedTemplate
from engine.character.parts.label_map import Labels
from engine.character.parts.regions import LimbRegion, body_in_one_piece, limb_in_one_piece

SHAPE = (60, 120)
LEFT, RIGHT, TORSO = (BODY_PARTS.index(name) for name in ("left_arm", "right_arm", "torso"))


def rectangle(rows: tuple[int, int], columns: tuple[int, int]) -> np.ndarray:
    mask = np.zeros(SHAPE, np.bool_)
    mask[slice(*rows), slice(*columns)] = True
    return mask


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
    own = np.ones(len(template.triangles), np.bool_)
    return limb_in_one_piece(found(labels), LEFT, (LEFT, RIGHT), template, own, shoulder)[0]


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


def test_an_arm_that_comes_out_in_two_places_is_led_from_one_to_the_other_behind_the_body() -> None:
    """More of it is seen at its shoulder than of its hand."""
    labels = np.full(SHAPE, -1)
    labels[5:55, 5:115] = TORSO
    labels[20:30, 10:50] = labels[20:30, 95:110] = LEFT
    whole = limb(labels, rectangle((20, 30), (8, 14)))
    assert whole[25, 10:110].all()
    assert not whole[:10].any() and not whole[50:].any()


def test_beside_an_arm_that_passes_behind_it_the_body_leaves_no_gap_but_at_the_shoulder() -> None:
    trunk, arm, joint = rectangle((5, 55), (5, 60)), rectangle((5, 55), (60, 70)), rectangle((5, 25), (55, 75))
    labels = found(np.where(trunk, TORSO, np.where(arm, LEFT, -1)))
    template, own = bar((5, 55), (5, 60)), np.ones(2, np.bool_)
    behind = LimbRegion(arm, ~own, LEFT, ~own, joint, behind=True)
    body = body_in_one_piece(labels, [behind], template, np.full((2, 3), TORSO), own)
    assert body[27:53, 60].all() and not body[:, 61:].any()
    assert not body[7:23, 60].any(), "a shoulder is no trunk's"
