"""Whose pixels beside a border are: drawn figures of which it is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.body.parts import BODY_PARTS
from engine.character.parts.colour_ownership import owned_by_colour, strange_colours

TORSO, LEFT_ARM, LEFT_LEG, RIGHT_LEG = (
    BODY_PARTS.index(name) for name in ("torso", "left_arm", "left_leg", "right_leg")
)
BLUE, SKIN, WHITE, WALL = (40, 60, 140), (220, 170, 140), (245, 245, 245), (90, 140, 60)
Drawn = tuple[NDArray[np.uint8], NDArray[np.int8]]


def beside_an_arm(sleeve: tuple[int, int, int]) -> Drawn:
    """A blue trunk, columns 20 to 79, and an arm beside it, 80 to 105."""
    rgb, labels = np.full((120, 130, 3), WALL, np.uint8), np.full((120, 130), -1, np.int8)
    rgb[10:110, 20:80], labels[10:110, 20:80] = BLUE, TORSO
    rgb[10:110, 80:106], labels[10:110, 80:106] = sleeve, LEFT_ARM
    return rgb, labels


def test_an_arms_pixels_that_are_labelled_as_the_trunks_are_the_arms() -> None:
    rgb, true = beside_an_arm(SKIN)
    wrong = true.copy()
    wrong[40:80, 80:86] = TORSO
    found = owned_by_colour(rgb, wrong)
    assert (found != true).sum() <= 0.2 * (wrong != true).sum(), "but for a column in which both are mixed"


def test_the_trunks_pixels_that_are_labelled_as_an_arms_are_the_trunks() -> None:
    rgb, true = beside_an_arm(SKIN)
    wrong = true.copy()
    wrong[40:80, 75:80] = LEFT_ARM
    found = owned_by_colour(rgb, wrong)
    assert (found != true).sum() <= 0.2 * (wrong != true).sum(), "but for a column in which both are mixed"


def test_where_sleeve_and_trunk_are_of_one_cloth_labels_stay() -> None:
    rgb, labels = beside_an_arm(BLUE)
    labels[40:80, 80:86] = TORSO
    assert (owned_by_colour(rgb, labels) == labels).all()
    assert not strange_colours(rgb, labels).any()


def test_a_shadow_beside_an_arm_is_strange_and_a_print_is_not() -> None:
    rgb, labels = beside_an_arm(SKIN)
    rgb[20:50, 77:80] = 5
    rgb[70:100, 70:77] = WHITE
    found = strange_colours(rgb, labels)
    assert found[22:48, 77:80].mean() > 0.9, "the shadow"
    assert not found[70:100, 70:76].any(), "white is neither skin nor dark"
    assert not found[labels < 0].any() and not found[:, 20:60].any()


def test_a_wall_between_two_legs_is_neithers() -> None:
    rgb, labels = np.full((120, 130, 3), WALL, np.uint8), np.full((120, 130), -1, np.int8)
    rgb[10:110, 20:60], rgb[10:110, 66:106] = BLUE, BLUE
    labels[10:110, 20:63], labels[10:110, 63:106] = LEFT_LEG, RIGHT_LEG
    found = strange_colours(rgb, labels)
    assert found[15:105, 61:65].all() and not found[15:105, 20:58].any() and not found[15:105, 68:106].any()
